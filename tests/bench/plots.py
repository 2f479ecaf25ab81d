"""Charts of the frame, of scaling and of the hierarchy. Needs matplotlib."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

# Colours that differ in lightness too (Okabe and Ito 2008), by method and by phase.
COLOURS = {"ours": "#0072b2", "solid-angle": "#d55e00", "solid-angle-table": "#e69f00",
           "brute-force": "#555555"}
CHANNELS = ("#c0392b", "#2e8b57", "#2c5aa0")
PHASES = {"scene": "#999999", "points": "#e69f00", "irradiance": "#f0c75e", "octree": "#8c6d1f",
          "cache": "#cccccc", "render": "#0072b2", "write": "#7fb8d8", "rest": "#dddddd"}
PEERS = (("Mitsuba 0.6 dipole, 2.2 % error", 46.4), ("pbrt-v2, 9 % error", 89.0))

plt.rcParams.update({
    "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.titlesize": 10,
    "axes.titleweight": "bold", "axes.titlelocation": "left", "svg.hashsalt": "sss",
    "legend.frameon": False,
})


def short(value):
    """A number as a person would write it."""
    if value >= 1e6:
        return f"{value / 1e6:g} M"
    return f"{value:.6f}".rstrip("0").rstrip(".") if value < 10 else f"{value:,.0f}"


def log_axis(axis, unit=short):
    """Written-out decades; 1, 2, 5 where there are few."""
    low, high = sorted(axis.get_view_interval())
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    steps = (1,) if math.log10(high / low) > 1.7 else (1, 2, 5)
    ticks = [step * 10.0 ** k for k in decades for step in steps]
    axis.set_major_locator(FixedLocator([tick for tick in ticks if low <= tick <= high]))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: unit(value)))


def percent(value):
    return short(100 * value) + " %"


def panels(count, width=8.4, height=3.1):
    columns = min(count, 2)
    rows = math.ceil(count / columns)
    figure, axes = plt.subplots(rows, columns, figsize=(width if columns > 1 else width * 0.62,
                                                        height * rows),
                                squeeze=False, layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0.03, 1, 0.97), h_pad=0.08, w_pad=0.08)
    flat = list(axes.flat)
    for axis in flat[count:]:
        axis.remove()
    return figure, flat[:count]


def label(axis, place, text, colour, offset=(5, 0), ha="left"):
    axis.annotate(text, place, xytext=offset, textcoords="offset points", color=colour, ha=ha,
                  va="center", fontsize=8, annotation_clip=False)


def label_ends(axis, ends, apart=10):
    """Names curves [(x, y, text, colour)] to the right of their ends, `apart` points at least
    between two names."""
    points_per_pixel = 72 / axis.figure.dpi
    axis.figure.draw_without_rendering()  # lays the axes out
    placed = -math.inf
    for x, y, text, colour in sorted(ends, key=lambda end: end[1]):
        wanted = axis.transData.transform((x, y))[1] * points_per_pixel
        placed = max(wanted, placed + apart)
        label(axis, (x, y), text, colour, (6, placed - wanted))


def curve_of(method):
    """(microseconds a receiver, 99.9 % error), by rising time."""
    return sorted((1e6 * entry["seconds"], entry["error"]["p999"]) for entry in method["curve"])


def error_over_time(scenes):
    """One chart a scene, one curve a method: what a receiver costs and how wrong it is."""
    figure, axes = panels(len(scenes))
    for axis, scene in zip(axes, scenes):
        axis.set(xscale="log", yscale="log", title=title_of(scene), xlabel="µs a receiver",
                 ylabel="error of 99.9 % of receivers")
        for method in scene["methods"]:
            colour = COLOURS[method["name"]]
            points = curve_of(method)
            if len(points) == 1:
                axis.axvline(points[0][0], color=colour, linestyle=(0, (4, 3)), linewidth=1.2)
            else:
                axis.plot(*zip(*points), color=colour, marker="o", markersize=3.5, linewidth=1.6)
        axis.set_ylim(axis.get_ylim()[0] / 1.5, 0.5)
        axis.set_xlim(min(axis.get_xlim()[0], 1), axis.get_xlim()[1] * 1.3)
        place_labels(axis, scene["methods"])
        log_axis(axis.xaxis)
        log_axis(axis.yaxis, percent)
    return figure


def title_of(scene):
    return f"{scene['title']}, {scene['points']:,} points"


def place_labels(axis, methods):
    for method in methods:
        points, colour, text = curve_of(method), COLOURS[method["name"]], method["label"]
        middle = min(points, key=lambda point: abs(math.log(max(point[1], 1e-12) / 0.003)))
        if len(points) == 1:
            axis.annotate(text, (points[0][0], 0.03), xycoords=("data", "axes fraction"),
                          xytext=(3, 0), textcoords="offset points", rotation=90, va="bottom",
                          fontsize=8, color=colour)
        elif method["name"] == "solid-angle-table":
            label(axis, middle, text.replace(", ", ",\n"), colour, (-9, -3), "right")
        elif method["name"] == "ours":
            label(axis, points[-1], text, colour, (-8, 0), "right")
        else:
            label(axis, points[0], text, colour, (7, 5))


def time_over_tolerance(scenes):
    """What a receiver costs if 99.9 % of them are to be within a tolerance."""
    figure, axes = panels(len(scenes))
    ends = []
    for axis, scene in zip(axes, scenes):
        axis.set(xscale="log", yscale="log", title=title_of(scene), xlabel="tolerance",
                 ylabel="µs a receiver")
        ends.append([])
        for method in scene["methods"]:
            colour, text = COLOURS[method["name"]], method["label"]
            points = [(float(target), 1e6 * seconds)
                      for target, seconds in method["timeTo"].items() if seconds is not None]
            if method["name"] == "ours":
                points = [(entry["setting"], 1e6 * entry["seconds"]) for entry in method["curve"]]
                text = "ours, asked for"
            if not points:
                continue
            points.sort(reverse=True)
            axis.plot(*zip(*points), color=colour, marker="o", markersize=3.5, linewidth=1.6)
            ends[-1].append((*points[-1], text, colour))
        axis.set_xlim(0.15, 0.7 * min(end[0] for end in ends[-1]))
        axis.set_ylim(min(axis.get_ylim()[0], 1), axis.get_ylim()[1] * 1.3)
        log_axis(axis.xaxis, percent)
        log_axis(axis.yaxis)
    for axis, names in zip(axes, ends):
        label_ends(axis, names)
    return figure


def tolerance_kept(scenes):
    """What was asked for and what came out, for ours."""
    figure, axes = panels(len(scenes))
    ends = []
    for axis, scene in zip(axes, scenes):
        axis.set(xscale="log", yscale="log", title=title_of(scene),
                 xlabel="tolerance asked for", ylabel="error, by channel")
        curve = sorted(((entry["setting"], entry["error"])
                        for entry in scene["methods"][0]["curve"]), key=lambda pair: pair[0])
        asked = [setting for setting, _ in curve]
        series = [(asked, "#333333", "-", "99.9 % may have"),
                  ([3 * a for a in asked], "#333333", (0, (4, 3)), "all may have"),
                  ([abs(error["bias"]) for _, error in curve], "#999999", "-", "|bias|")]
        for figure_name, style in (("max", (0, (1, 1.5))), ("p999", "-")):
            for channel, colour in enumerate(CHANNELS):
                axis.plot(asked, [error["channels"][channel][figure_name] for _, error in curve],
                          color=colour, linestyle=style, linewidth=1.3, marker="o", markersize=2.5)
        for values, colour, style, _ in series:
            axis.plot(asked, values, color=colour, linestyle=style, linewidth=1)
        ends.append([(asked[-1], values[-1], text, colour) for values, colour, _, text in series])
        for figure_name, text in (("p999", "99.9 %"), ("max", "max (dotted)")):
            ends[-1].append((asked[-1], curve[-1][1][figure_name], text, CHANNELS[2]))
        log_axis(axis.xaxis, percent)
        log_axis(axis.yaxis, percent)
    for axis, names in zip(axes, ends):
        label_ends(axis, names)
    return figure


def scaling(measured):
    """Interactions and time against the logarithm of the number of points."""
    figure, (left, right) = panels(2, height=3.4)
    sizes = [size["points"] for size in measured["sizes"]]
    entries = [size["methods"][0]["curve"][0] for size in measured["sizes"]]
    # Through the size nearest 10^5, from where on the profile is resolved: growth as log N, which
    # is a straight line here.
    through = min(range(len(sizes)), key=lambda i: abs(math.log(sizes[i] / 1e5)))
    logarithm = [math.log(n) / math.log(sizes[through]) for n in sizes]
    ends = []
    series = (
        (left, "interactions", [e["counts"]["interactions"] for e in entries],
         "interactions a receiver"),
        (right, "time", [1e6 * e["seconds"] for e in entries], "µs a receiver"),
    )
    for axis, name, values, unit in series:
        axis.set(xscale="log", xlabel="points", ylabel=unit,
                 title=f"{name}: {measured['scene']}, tolerance 1 %")
        axis.plot(sizes, values, color=COLOURS["ours"], marker="o", markersize=4, linewidth=1.6)
        axis.plot(sizes, [values[through] * k for k in logarithm], color="#555555", linewidth=1,
                  linestyle=(0, (4, 3)))
        ends.append([(sizes[-1], values[through] * logarithm[-1], "as log N", "#555555"),
                     (sizes[-1], values[-1], "measured", COLOURS["ours"])])
        if axis is left:
            nodes = [e["counts"]["nodes"] for e in entries]
            axis.plot(sizes, nodes, color="#7fb8d8", marker="o", markersize=3, linewidth=1.2)
            ends[-1].append((sizes[-1], nodes[-1], "nodes alone", "#4a90b8"))
        axis.set_ylim(bottom=0)
        log_axis(axis.xaxis)
    for axis, names in zip((left, right), ends):
        label_ends(axis, names)
    return figure


def frame(measured):
    """CPU seconds of the whole scene by phase."""
    figure, (axis,) = panels(1, width=11.5, height=2.9)
    names = ("all", "moved", "lambertian", "both")
    programs = measured["programs"]
    texts = {name: programs[name]["label"] for name in names if name in programs}
    texts["both"] = "both passes"
    highest = 0
    for row, name in enumerate(names):
        parts = phases(programs[name]) if name != "both" else \
            phases(programs["preprocess"]) + phases(programs["render"])
        left = 0
        for phase, seconds in parts:
            axis.barh(row, seconds, left=left, color=PHASES.get(phase, "#dddddd"),
                      edgecolor="white", linewidth=0.5, height=0.62)
            if seconds > 0.35:
                dark = phase in ("render", "octree")
                axis.text(left + seconds / 2, row, phase, ha="center", va="center", fontsize=7.5,
                          color="white" if dark else "#222222")
            left += seconds
        label(axis, (left, row), f"{left:.2f} s", "#222222")
        highest = max(highest, left)
    error = measured["accuracy"]["error"]
    axis.set_yticks(range(len(names)), [texts[name] for name in names])
    axis.set(xlabel="CPU seconds", xlim=(0, highest * 1.12),
             title=f"bunny, marble: {100 * error['rmsOfMean']:.2f} % RMS error of exitance")
    axis.grid(False, axis="y")
    peers = ", ".join(f"{name}: {seconds:g} s" for name, seconds in PEERS)
    axis.text(0, -0.32, f"for comparison, {peers}", transform=axis.transAxes, fontsize=7.5,
              color="#555555")
    return figure


def phases(run):
    """[(phase, CPU seconds)] of the cheapest run, start and end of the process as "rest"."""
    found = dict(run["stats"]["cpuSeconds"])
    found.pop("total")
    parts = list(found.items())
    return [*parts, ("rest", max(0.0, run["cpuMin"] - sum(found.values())))]
