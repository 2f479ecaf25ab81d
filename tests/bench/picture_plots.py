"""Charts of whole pictures: error over time, and the models' own errors."""

from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from plots import COLOURS, log_axis, panels, percent

METHOD_COLOURS = {"cached": COLOURS["ours"], "solid-angle": COLOURS["solid-angle"],
                  "brute-force": COLOURS["brute-force"], "bssrdf": "#009e73", "volume": "#b0589a"}


TIMES = {0.01: "0.01 s", 0.1: "0.1 s", 1: "1 s", 10: "10 s", 60: "1 min", 600: "10 min",
         3600: "1 h", 36000: "10 h", 864000: "10 d", 8640000: "100 d"}


def time_axis(axis):
    """Seconds as people say them, nearly a decade apart."""
    low, high = axis.get_view_interval()
    ticks = [time for time in TIMES if low <= time <= high]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: TIMES[value]))


def error_over_time(scenes):
    """One chart a scene, one curve a method; dotted is beyond what was measured."""
    figure, axes = panels(len(scenes))
    for axis, scene in zip(axes, scenes):
        axis.set(xscale="log", yscale="log", title=scene["title"],
                 xlabel="CPU time of the picture", ylabel="RMS error")
        highest = 0
        for target in scene["methods"][0]["timeTo"]:
            axis.axhline(float(target), color="#bbbbbb", linewidth=0.8)
        for method in scene["methods"]:
            points = [(entry["seconds"], entry["error"]) for entry in method["curve"]
                      if entry["error"] > 0]
            points.sort()
            highest = max(highest, points[0][1])
            draw_method(axis, method, points)
        axis.set_ylim(axis.get_ylim()[0], min(30, 2 * highest))
        axis.set_xlim(axis.get_xlim()[0], 3 * axis.get_xlim()[1])
        time_axis(axis.xaxis)
        log_axis(axis.yaxis, percent)
    place_legend(figure, axes[0])
    return figure


def draw_method(axis, method, points):
    colour = METHOD_COLOURS[method["name"]]
    axis.plot(*zip(*points), color=colour, marker="o", markersize=3.5, linewidth=1.6,
              label=method["label"], zorder=3 if method["name"] == "cached" else 2)
    far = [(found["seconds"], float(target)) for target, found in method["timeTo"].items()
           if found["extrapolated"]]
    if far:
        axis.plot(*zip(points[-1], *far), color=colour, linewidth=1.1, linestyle=(0, (1, 2)))


def place_legend(figure, axis):
    figure.get_layout_engine().set(rect=(0, 0.03, 1, 0.91))
    handles, labels = axis.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncols=len(labels), fontsize=8,
                  bbox_to_anchor=(0.5, 0.995), handlelength=1.6, columnspacing=1.4)


def model_errors(scenes):
    """Mean and RMS difference of every model to `volume`, with two standard errors."""
    figure, axes = panels(len(scenes), height=2.5)
    for axis, scene in zip(axes, scenes):
        axis.set(title=scene["title"], xlabel="difference to radiative transfer")
        models = scene["models"][::-1]
        for row, model in enumerate(models):
            for name, colour, up in (("mean", "#0072b2", 0.12), ("rms", "#d55e00", -0.12)):
                axis.errorbar(100 * model[name], row + up,
                              xerr=200 * model[name + "StandardError"], color=colour, fmt="o",
                              markersize=4, elinewidth=1.2,
                              label={"mean": "mean", "rms": "RMS"}[name] if row == 0 else None)
        axis.axvline(0, color="#555555", linewidth=0.9)
        axis.set_yticks(range(len(models)), [model["label"] for model in models])
        axis.xaxis.set_major_formatter(lambda value, _: f"{value:g} %")
        axis.grid(False, axis="y")
    place_legend(figure, axes[0])
    return figure
