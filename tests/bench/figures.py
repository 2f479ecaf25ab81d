"""The measurements as tables of text, for people: the report has them as HTML, README.md as
Markdown."""

import dataclasses

import tables


@dataclasses.dataclass
class Table:
    title: str
    head: list
    rows: list
    note: str = ""
    part: str = ""


def all_tables(result):
    """What was measured, in the order of the report."""
    made = []
    if result.get("pictures"):
        made += [time_to_error(result["pictures"]), picture_curves(result["pictures"])]
    if result.get("models"):
        made.append(model_errors(result["models"]))
    if result.get("peer", {}).get("scenes"):
        made.append(peer(result["peer"]))
    if "frame" in result:
        made += [whole_scene(result["frame"]), exitance_cost(result["frame"]["exitance"]),
                 exitance_error(result["frame"])]
    if "scaling" in result:
        made.append(scaling(result["scaling"]))
    if result.get("scenes"):
        made += [receiver_times(result["scenes"]), interactions(result["scenes"], result["about"])]
    return made


def markdown(result):
    """For README.md."""
    about = result["about"]
    text = (f"{about['date'][:10]}, {about['cores']} cores of an {about['processor']}, "
            f"{about['clockHertz'] / 1e9:.1f} GHz, {about['instructionSet']}, commit "
            f"{about['commit']}, load {about['load']:.1f}: `{about['command']}`\n")
    for table in all_tables(result):
        text += f"\n### {table.title}\n\n" + (f"{table.note}\n\n" if table.note else "")
        for row in (table.head, ["---"] * len(table.head), *table.rows):
            text += "| " + " | ".join(row) + " |\n"
    return text


def text(result):
    """For the terminal: what tables.summary does not say."""
    lines = []
    for table in all_tables(result):
        if table.part in ("pictures", "models", "peer"):
            grid = [table.head, *table.rows]
            widths = [max(len(row[k]) for row in grid) for k in range(len(table.head))]
            lines += ["", table.title]
            lines += ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
                      for row in grid]
    return "\n".join(lines)


def seconds(value):
    """In the unit that a person would take."""
    if value < 99.5:
        return f"{value:.2g} s" if value < 9.95 else f"{value:.0f} s"
    if value < 5940:
        return f"{value / 60:.0f} min"
    if value < 99 * 3600:
        return f"{value / 3600:.0f} h"
    return f"{value / 86400:,.0f} d"


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def spread(value, error):
    """In percent, with its standard error; what noise hides is below it."""
    if value == 0:
        return f"< {100 * error:.0f} %"
    digits = 1 if error >= 0.0005 else 2
    return f"{100 * value:.{digits}f} ± {100 * error:.{digits}f} %"


def time_to_error(scenes):
    def cell(found):
        if found["seconds"] is None:
            return "-"
        return ("≈ " if found["extrapolated"] else "") + seconds(found["seconds"])

    targets = list(scenes[0]["methods"][0]["timeTo"])
    rows = []
    for scene in scenes:
        rows += [[scene["title"], method["label"],
                  *(cell(method["timeTo"][target]) for target in targets)]
                 for method in scene["methods"]]
    return Table("CPU time of a picture until its error is small",
                 ["scene", "method", *(f"{float(t):.0%} RMS error" for t in targets)], rows,
                 f"{scenes[0]['size']} x {scenes[0]['size']} pixels; relative RMS error of the "
                 "diffusion layer over the object, by the method alone, against the converged "
                 "picture of its own model. ≈ is beyond what was measured, by the square root of "
                 "the samples; - was not reached.", "pictures")


def picture_curves(scenes):
    rows = []
    for scene in scenes:
        for method in scene["methods"]:
            for entry in method["curve"]:
                bias = entry.get("bias")
                rows.append([scene["title"], method["label"],
                             f"{method['setting']} {entry['setting']:.3g}",
                             f"{entry['seconds']:.2f}", percent(entry["error"]),
                             "" if bias is None else f"{100 * bias:+.3f} %",
                             percent(entry["maximum"], 1) if "maximum" in entry else "",
                             f"{entry['flip']:.4f}" if "flip" in entry else ""])
    return Table("All points of the curves",
                 ["scene", "method", "setting", "CPU s", "RMS", "bias", "max", "FLIP"], rows, "",
                 "details")


def model_errors(scenes):
    """A column a scene, so that the whole is one table."""
    labels = {}
    for scene in scenes:
        labels.update((model["name"], model["label"]) for model in scene["models"])
    by_name = [{model["name"]: model for model in scene["models"]} for scene in scenes]

    def cell(model):
        if model is None:
            return "-"
        return (spread(model["mean"], model["meanStandardError"]) + "; "
                + spread(model["rms"], model["rmsStandardError"]))
    rows = [[label, *(cell(models.get(name)) for models in by_name)]
            for name, label in labels.items()]
    return Table("What a model is wrong by, however long it runs",
                 ["model", *(scene["title"] for scene in scenes)], rows,
                 "Against radiative transfer (volume): mean; RMS difference over the object's "
                 "pixels and the mean there, with standard errors by the seeds of volume; the noise "
                 f"of both is taken off. {scenes[0]['size']} x {scenes[0]['size']} pixels.",
                 "models")


def peer(found):
    rows = []
    for scene in found["scenes"]:
        for name, side in (("sss volume", scene["ours"]), (found["label"], scene["peer"])):
            rows.append([scene["title"], name, f"{side['samples']} x {side['seeds']}",
                         *(f"{mean:.5f} ± {error:.5f}" for mean, error in
                           zip(side["mean"], side["standardError"])),
                         f"{side['cpu']:.1f}"])
        rows.append(["", "difference, standard errors", "",
                     *(f"{100 * d:+.2f} % ({s:+.1f})" for d, s in
                       zip(scene["difference"], scene["sigmas"])), ""])
    return Table("The judge judged", ["scene", "renderer", "samples x seeds", "red", "green",
                                      "blue", "CPU s"], rows,
                 "Mean radiance over the object's pixels, reflection at its surface and all.",
                 "peer")


def whole_scene(frame):
    runs = frame["programs"]
    twin = runs["lambertian"]["cpuMin"]

    def row(run, factor=True):
        times = f" ({run['cpuMin'] / twin:.2f} x)" if factor else ""
        return [run["label"], f"{run['cpuMin']:.2f}{times}", f"{run['cpuMedian']:.2f}",
                f"{run['memory'] / 2**20:.0f} MiB"]
    both = runs["preprocess"]["cpuMin"] + runs["render"]["cpuMin"]
    rows = [row(runs["preprocess"], False), row(runs["render"], False),
            ["**both passes**", f"**{both:.2f}** ({both / twin:.2f} x)", "", ""],
            row(runs["moved"]), row(runs["movedShape"]), row(runs["all"]), row(runs["lambertian"], False),
            *turntable_rows(frame["turntable"])]
    counts = frame["counts"]
    return Table("Whole scene", ["run", "CPU s, least (x Lambertian)", "median", "memory"], rows,
                 f"{counts['points']:,} points, {counts['nodes']:,} nodes; {counts['sites']:,} "
                 f"sites, {counts['receivers']:,} receivers with "
                 f"{counts['interactionsPerReceiver']:,.0f} interactions each; "
                 f"{counts['lookups']:,} lookups at "
                 f"{1e9 * frame['accuracy']['lookupSeconds']:.0f} ns.", "frame")


def exitance_cost(exitance):
    """What the first frame of a light pays for exitance, by the profile and on the shape."""
    places = ("everywhere", "seen")
    profile, solution = exitance["profile"], exitance["solution"]

    def cell(costs, factors):
        """Of each place; `factors` where it is the whole price."""
        cells = []
        for key, form in (("interactions", lambda number: f"{number / 1e6:.1f} M"),
                          ("seconds", lambda number: f"{number:.2f}")):
            for place, cost in zip(places, costs):
                times = f" ({cost[key] / profile[place][key]:.1f} x)" if factors else ""
                cells.append(form(cost[key]) + times)
        return cells
    corrected = [exitance["corrected"][place] for place in places]
    both = [{key: cost[key] + solution[key] for key in cost} for cost in corrected]
    rows = [["by the dipole", *cell([profile[place] for place in places], False)],
            ["on the shape", *cell(both, True)],
            ["of it, solved once", *cell([solution] * 2, False)]]
    return Table("Exitance of the whole scene", [
        "exitance", "interactions, everywhere", "where the picture sees it", "CPU s, everywhere",
        "where the picture sees it"], rows,
        f"{exitance['points']:,} points, {exitance['sums']} sums of the layers; tolerance "
        f"{100 * exitance['tolerance']:.2g} %.", "frame")


def turntable_rows(turntable):
    marble, twin = turntable["later"]["marble"], turntable["later"]["lambertian"]
    return [["turntable, a frame after the first", f"{marble:.2f} ({turntable['ratio']:.2f} x its "
             "twin)", "", ""],
            ["turntable's Lambertian twin, likewise", f"{twin:.2f}", "", ""]]


def exitance_error(frame):
    accuracy, reference = frame["accuracy"], frame["reference"]
    labels = (("error", "**all of it**"),
              ("fromInterpolationAndHierarchy",
               f"from hierarchy and sites (tolerance {accuracy['tolerance']:.0%})"),
              ("fromLightNoise", "from light's noise"), ("fromPoints", "from the points"),
              ("ofReference", f"of the reference ({reference['points']:,} points)"))
    rows = []
    for name, text in labels:
        error = accuracy[name]
        rows.append([text, percent(error["rmsOfMean"]), f"{100 * error['biasOfMean']:+.3f} %",
                     percent(error["p999"]), percent(error["max"])])
    return Table("Error of the whole scene's exitance", ["error", "RMS", "bias", "99.9 %", "max"],
                 rows, "", "frame")


def scaling(measured):
    rows = [[f"{row['cloudPoints']:,}", f"{row['nsPerReceiver'] / 1e3:.1f}",
             f"{row['interactions']:,.0f}", f"{row['nsPerInteraction']:.1f}",
             percent(row["p999"], 4)] for row in tables.scaling_rows(measured)]
    return Table("Cost against the number of points",
                 ["points", "µs a receiver", "interactions", "ns each", "99.9 % within"], rows,
                 f"{measured['scene']}, tolerance {measured['tolerance']:.0%}.", "scaling")


def receiver_times(scenes):
    targets = list(scenes[0]["methods"][0]["timeTo"])
    rows = []
    for scene in scenes:
        for method in scene["methods"]:
            cells = []
            for target in targets:
                time = method["timeTo"][target]
                cells.append("-" if time is None else f"{1e6 * time:,.1f}")
                asked = [entry["seconds"] for entry in method["curve"]
                         if method["name"] == "ours" and entry["setting"] == float(target)]
                if asked:
                    cells[-1] += f" ({1e6 * asked[0]:,.1f})"
            rows.append([f"{scene['title']}, {scene['points']:,} points", method["label"], *cells])
    return Table("Time of a receiver until 99.9 % are within an error",
                 ["scene", "method", *(f"{100 * float(t):g} %" for t in targets)], rows,
                 "µs; - was not reached. Ours in brackets: what asking for that tolerance costs.",
                 "hierarchy")


def interactions(scenes, about):
    scene = scenes[0]
    rows = []
    for method in scene["methods"]:
        row = tables.typical_row(method)
        rows.append([method["label"], f"{row['interactions']:,.0f}",
                     f"{row['nsPerInteraction']:.1f}", f"{row['exponentialsPerInteraction']:.0f}",
                     f"{row['squareRootsPerInteraction']:.0f}",
                     f"{row['tableRowsPerInteraction']:.0f}", f"{row['flopsPerInteraction']:.0f}",
                     f"{row['bytesPerInteraction']:.0f}", tables.of_peak(row, about).strip("()")])
    return Table(f"What an interaction costs: {scene['title']}, near 1 %",
                 ["method", "interactions", "ns each", "exps", "roots", "rows", "flops", "bytes",
                  "of peak"], rows, "", "hierarchy")
