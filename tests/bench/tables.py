"""The measurements as CSV and as text."""

import csv
import math


def write(result, folder):
    if "frame" in result:
        save(folder / "frame.csv", frame_rows(result["frame"]))
    if "scaling" in result:
        save(folder / "scaling.csv", scaling_rows(result["scaling"]))
    if result.get("scenes"):
        save(folder / "hierarchy.csv", hierarchy_rows(result["scenes"]))
    if result.get("pictures"):
        save(folder / "pictures.csv", picture_rows(result["pictures"]))
        save(folder / "time-to-error.csv", time_rows(result["pictures"]))
    if result.get("models"):
        save(folder / "models.csv", model_rows(result["models"]))


def save(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def frame_rows(frame):
    return [{
        "run": name, "label": run["label"], "cpuMinS": run["cpuMin"],
        "cpuMedianS": run["cpuMedian"], "wallMinS": run["wallMin"], "memoryBytes": run["memory"],
    } for name, run in frame["programs"].items()]


def curve_row(entry, method):
    counts, error, cost = entry["counts"], entry["error"], method["cost"]
    interactions = max(counts["interactions"], 1)
    flops = sum(counts[kind + "s"] * cost[kind + "Flops"] for kind in ("local", "node", "point"))
    moved = ((counts["locals"] + counts["nodes"]) * cost["nodeBytes"]
             + counts["points"] * cost["pointBytes"])
    row = {
        "method": method["name"], "setting": entry["setting"],
        "nsPerReceiver": 1e9 * entry["seconds"],
        "nsPerReceiverMedian": 1e9 * entry["secondsMedian"],
        "interactions": counts["interactions"], "locals": counts["locals"],
        "nodes": counts["nodes"], "points": counts["points"], "nodesVisited": counts["nodesVisited"],
        "nsPerInteraction": 1e9 * entry["seconds"] / interactions,
        "exponentialsPerInteraction": cost["exponentials"],
        "squareRootsPerInteraction": cost["squareRoots"],
        "tableRowsPerInteraction": cost["tableRows"],
        "flopsPerInteraction": flops / interactions, "bytesPerInteraction": moved / interactions,
        "gigaflops": flops / entry["seconds"] / 1e9,
        "rms": error["rms"], "bias": error["bias"], "p999": error["p999"], "max": error["max"],
    }
    for channel, name in zip(error["channels"], "RGB"):
        for figure in ("rms", "bias", "p999", "max"):
            row[figure + name] = channel[figure]
    return row


def scaling_rows(scaling):
    return [{"cloudPoints": size["points"], "cloudNodes": size["nodes"],
             "octreeCpuS": size["octreeCpuSeconds"], **curve_row(entry, method)}
            for size in scaling["sizes"] for method in size["methods"] for entry in method["curve"]]


def hierarchy_rows(scenes):
    return [{"scene": scene["name"], "cloudPoints": scene["points"], **curve_row(entry, method)}
            for scene in scenes for method in scene["methods"] for entry in method["curve"]]


def picture_rows(scenes):
    return [{"scene": scene["name"], "method": method["name"], "setting": entry["setting"],
             "cpuS": entry["seconds"], "error": entry["error"],
             **{key: entry.get(key) for key in ("bias", "maximum", "flip")}}
            for scene in scenes for method in scene["methods"] for entry in method["curve"]]


def time_rows(scenes):
    return [{"scene": scene["name"], "method": method["name"], "error": target,
             "cpuS": found["seconds"], "extrapolated": found["extrapolated"]}
            for scene in scenes for method in scene["methods"]
            for target, found in method["timeTo"].items()]


def model_rows(scenes):
    return [{"scene": scene["name"], "model": model["name"],
             "cpuS": model["seconds"],
             **{key: model[key] for key in ("mean", "meanStandardError", "rms",
                                            "rmsStandardError")}}
            for scene in scenes for model in scene["models"]]


def summary(result):
    """What fits a terminal: times with their errors."""
    about = result["about"]
    lines = [f"{about['processor']}, {about['cores']} cores, {about['clockHertz'] / 1e9:.2f} GHz, "
             f"peak {about['peakFlops'] / 1e9:.0f} Gflop/s a core, {about['instructionSet']}; "
             f"commit {about['commit']}, load {about['load']:.1f}"]
    if "frame" in result:
        lines += frame_summary(result["frame"])
    if "scaling" in result:
        lines += scaling_summary(result["scaling"], about)
    for scene in result.get("scenes", []):
        lines += scene_summary(scene, about)
    return "\n".join(lines)


def percent(error):
    return (f"{100 * error['rmsOfMean']:.3f} % RMS, bias {100 * error['biasOfMean']:+.3f} %, "
            f"99.9 % within {100 * error['p999']:.2f} %, max {100 * error['max']:.2f} %")


def frame_summary(frame):
    lines = ["", "whole scene               CPU s min   median   wall s   MiB"]
    for run in frame["programs"].values():
        lines.append(f"{run['label']:28}{run['cpuMin']:7.2f}{run['cpuMedian']:9.2f}"
                     f"{run['wallMin']:9.2f}{run['memory'] / 2**20:6.0f}")
    accuracy, reference = frame["accuracy"], frame["reference"]
    runs = frame["programs"]
    both = runs["preprocess"]["cpuMin"] + runs["render"]["cpuMin"]
    lines += [
        f"both passes                 {both:7.2f}  "
        f"({both / runs['lambertian']['cpuMin']:.2f} x Lambertian); further frame "
        f"{runs['moved']['cpuMin'] / runs['lambertian']['cpuMin']:.2f} x, with all effects "
        f"{runs['all']['cpuMin'] / runs['lambertian']['cpuMin']:.2f} x",
        "exitance on the shape, of the dipole's: "
        f"{exitance_ratio(frame['exitance'], 'seconds'):.1f} x CPU s, "
        f"{exitance_ratio(frame['exitance'], 'interactions'):.1f} x interactions",
        "turntable, frames after the first "
        f"{frame['turntable']['later']['marble']:.2f} CPU s "
        f"({frame['turntable']['ratio']:.2f} x Lambertian)",
        f"error of exitance           {percent(accuracy['error'])}",
        f"  from hierarchy and sites  {percent(accuracy['fromInterpolationAndHierarchy'])}",
        f"  from light's noise        {percent(accuracy['fromLightNoise'])}",
        f"  from the points           {percent(accuracy['fromPoints'])}",
        f"  of the reference          {percent(accuracy['ofReference'])} "
        f"({reference['points']} points, {reference['irradianceSamples']} light samples each, "
        "2 seeds)",
        "counts                      " + ", ".join(
            f"{value:.0f} {name}" for name, value in frame["counts"].items()),
        f"lookup of computed exitance {1e9 * accuracy['lookupSeconds']:.0f} ns",
    ]
    return lines


def exitance_ratio(exitance, key):
    """Everywhere on the body, with what solving takes."""
    return ((exitance["solution"][key] + exitance["corrected"]["everywhere"][key])
            / exitance["profile"]["everywhere"][key])


def scaling_summary(scaling, about):
    lines = ["", f"{scaling['scene']}, tolerance {scaling['tolerance']}",
             "   points   us a receiver  interactions   ns each  Gflop/s (of peak)  99.9 %     max"]
    for row in scaling_rows(scaling):
        lines.append(f"{row['cloudPoints']:9d}{row['nsPerReceiver'] / 1e3:16.2f}"
                     f"{row['interactions']:14.0f}{row['nsPerInteraction']:10.2f}"
                     f"{row['gigaflops']:10.1f} {of_peak(row, about)}{row['p999']:14.1e}"
                     f"{row['max']:10.1e}")
    return lines


def scene_summary(scene, about):
    lines = ["", f"{scene['title']}: {scene['points']} points; us a receiver until 99.9 % are "
             "within"]
    targets = list(scene["methods"][0]["timeTo"])
    lines.append(" " * 26 + "".join(f"{float(target):>10.2%}" for target in targets))
    for method in scene["methods"]:
        times = (method["timeTo"][target] for target in targets)
        lines.append(f"  {method['label']:24}" + "".join(
            "         -" if t is None else f"{1e6 * t:10.1f}" for t in times))
    lines.append("  what an interaction costs, near an error of 1 % (ours: asked for 1 %)")
    lines.append(" " * 26 + "     each  ns each  exps  roots  rows  flops  bytes  "
                 "Gflop/s (of peak)")
    return lines + [counts_line(method, about) for method in scene["methods"]]


def typical_row(method):
    """Near an error of 1 %; of ours, asked for 1 %."""
    def distance(entry):
        if method["name"] == "ours":
            return abs(math.log(entry["setting"] / 0.01))
        return abs(math.log(max(entry["error"]["p999"], 1e-12) / 0.01))

    return curve_row(min(method["curve"], key=distance), method)


def counts_line(method, about):
    row = typical_row(method)
    return (f"  {method['label']:24}{row['interactions']:9.0f}{row['nsPerInteraction']:9.2f}"
            f"{row['exponentialsPerInteraction']:6.0f}{row['squareRootsPerInteraction']:7.0f}"
            f"{row['tableRowsPerInteraction']:6.0f}{row['flopsPerInteraction']:7.0f}"
            f"{row['bytesPerInteraction']:7.0f}{row['gigaflops']:9.1f} {of_peak(row, about)}")


def of_peak(row, about):
    if not about["peakFlops"]:
        return "(peak unknown)"
    return f"({row['gigaflops'] / (about['peakFlops'] / 1e9):.0%})"
