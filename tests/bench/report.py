"""The report: one HTML file with everything in it. Without matplotlib it has no charts."""

import base64
import html
import pathlib
import re
import string

import figures

TEMPLATE = pathlib.Path(__file__).with_name("report_template.html")
# The colours of sss-render --error-image, from 0.001 to 1.
RAMP = ("#000004", "#56106e", "#bb3754", "#f98c0a", "#fcffa4")
SECTIONS = (
    ("pictures", "Pictures", "The same picture by every method: what it costs and how wrong it is. "
     "Every error is the method's own: pictures compared share their camera rays, so that pixel "
     "sampling cancels; that of volume, which shares none, is taken off."),
    ("models", "Models", "A method can only be as good as its model. Here pictures of every "
     "diffusion profile and of diffusion on the shape, all with single scattering and all light that "
     "enters again, stand beside radiative transfer."),
    ("peer", "A second judge", "The judge of the models, volume, beside another renderer's "
     "volumetric path tracer on the same scenes."),
    ("frame", "Whole scene", "The benchmark's bunny as a user renders it, and where its error comes "
     "from."),
    ("scaling", "Scaling", "The diffusion sum alone, by the number of points."),
    ("hierarchy", "Hierarchy", "The diffusion sum alone: every method sums over the same points, "
     "and its error is that against the whole sum in double precision."),
)
CHARTS = {
    "pictures": [("error-over-time", "Error of the diffusion layer over CPU time of the whole picture, all "
                  "passes. Grey lines: 2 % and 1 %. Dotted: extrapolated by the square root of the "
                  "samples.")],
    "models": [("models", "Mean and RMS difference to radiative transfer over the object, with two "
                "standard errors.")],
    "frame": [("frame", "CPU seconds by phase.")],
    "scaling": [("scaling", "Interactions and time of a receiver.")],
    "hierarchy": [
        ("receiver-error-over-time", "Error over time of a receiver."),
        ("time-over-tolerance", "Ours by the tolerance asked for, others by the error they have."),
        ("tolerance-kept", "Tolerance asked for, and error found.")],
}


def write(result, folder):
    tables = figures.all_tables(result)
    sections = []
    for key, title, text in SECTIONS:
        content = [*(chart(folder, *each) for each in CHARTS.get(key, ())),
                   *(table_of(table) for table in tables if table.part == key)]
        if key == "pictures" and result.get("pictures"):
            content += [side_by_side(scene, folder) for scene in result["pictures"]]
            content += [folded(table) for table in tables if table.part == "details"]
        if any(content):
            sections.append((key, title, f'<section id="{key}"><h2>{title}</h2>\n<p>{text}</p>\n'
                             + "\n".join(content) + "\n</section>"))
    about = result["about"]
    page = string.Template(TEMPLATE.read_text()).substitute(
        date=about["date"][:10], ramp=", ".join(RAMP),
        headline=html.escape(f"{about['date'][:10]}, {about['scale']} run, {about['processor']}, "
                             f"commit {about['commit']}"),
        nav="".join(f'<a href="#{key}">{title}</a>' for key, title, _ in sections)
        + '<a href="#machine">Machine and commands</a>',
        body="\n".join(text for _, _, text in sections) + machine(result))
    (folder / "report.html").write_text(page)


def chart(folder, name, caption):
    """An SVG of matplotlib's inside the page: names made its own, for all share one page."""
    path = folder / f"{name}.svg"
    if not path.exists():
        return ""
    svg = path.read_text()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r'(id="|url\(#|href="#)', rf"\g<1>{name}-", svg)
    return (f'<figure role="img" aria-label="{html.escape(caption)}">{svg}'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>")


def cell(text, kind):
    """A cell, left if it is text; **bold** as in Markdown."""
    left = "" if re.match(r"^[-+≈*]*\s?[\d.]|^-?$", text) else ' class="text"'
    if kind == "th":
        left = ' class="text"' if text in TEXT_HEADS else ""
    bold = re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", html.escape(text))
    return f"<{kind}{left}>{bold}</{kind}>"


TEXT_HEADS = {"scene", "method", "model", "run", "error", "renderer", "setting"}
OURS = {"ours", "cached, both passes"}


def rows_of(table):
    """Table rows; a first cell that repeats is left empty, and a new one has a line above."""
    lines, last = [], None
    for row in table.rows:
        first = row[0]
        kinds = ["group"] if first and first != last and table.head[0] == "scene" else []
        if len(row) > 1 and row[1] in OURS:
            kinds.append("ours")
        cells = ["" if first == last else first, *row[1:]]
        lines.append(f'<tr class="{" ".join(kinds)}">'
                     + "".join(cell(text, "td") for text in cells) + "</tr>")
        last = first
    return "\n".join(lines)


def table_of(table, heading=True):
    title = f"<h3>{html.escape(table.title)}</h3>" if heading else ""
    note = f'<p class="note">{html.escape(table.note)}</p>' if table.note else ""
    head = "".join(cell(text, "th") for text in table.head)
    return (f'{title}{note}<div class="scroll"><table><thead><tr>{head}</tr></thead>\n'
            f"<tbody>{rows_of(table)}</tbody></table></div>")


def folded(table):
    return f"<details><summary>{html.escape(table.title)}</summary>{table_of(table, False)}</details>"


def image(path, what):
    data = base64.b64encode(path.read_bytes()).decode()
    return f'<img alt="{html.escape(what)}" src="data:image/png;base64,{data}">'


def side_by_side(scene, folder):
    """Buttons of the methods; a slider between picture and reference, and the error beside it."""
    buttons, views = [], []
    for k, view in enumerate(scene["sideBySide"]):
        key = f"view-{scene['name']}-{view['name']}"
        buttons.append(f'<button type="button" data-view="{key}" '
                       f'aria-pressed="{str(k == 0).lower()}">{html.escape(view["label"])}</button>')
        caption = (f"{view['label']}, {view['setting']}: {figures.seconds(view['seconds'])}, "
                   f"RMS error {figures.percent(view['error'])}")
        views.append(
            f'<div class="view" id="{key}"{"" if k == 0 else " hidden"}><div class="pair">'
            f'<div class="slider">{image(folder / view["picture"], view["label"])}'
            f'{image(folder / view["reference"], "reference")}'
            '<input type="range" min="0" max="100" value="50" aria-label="method or reference">'
            f'<span class="tag left">{html.escape(view["name"])}</span>'
            '<span class="tag right">reference</span></div>'
            f'{image(folder / view["errorImage"], "error of " + view["label"])}</div>'
            f'<p class="note">{html.escape(caption)}. {html.escape(view["note"])}</p></div>')
    return (f"<h3>{html.escape(scene['title'])}</h3><div class=\"tabs\">{''.join(buttons)}</div>"
            + "".join(views)
            + '<p class="note">Right: |difference| over the mean, 0.1 %<span class="scale"></span>'
            "100 %</p>")


def machine(result):
    about = result["about"]
    facts = {"command": about["command"], "commit": about["commit"], "date": about["date"],
             "processor": about["processor"], "cores": about["cores"],
             "clock": f"{about['clockHertz'] / 1e9:.2f} GHz",
             "peak of a core": f"{about['peakFlops'] / 1e9:.0f} Gflop/s",
             "instructions": about["instructionSet"], "system": about["system"],
             "load at the start": f"{about['load']:.1f}"}
    items = "".join(f"<dt>{key}</dt><dd>{html.escape(str(value))}</dd>"
                    for key, value in facts.items())
    commands = "".join(f"<p><code>{html.escape(line)}</code></p>"
                       for line in command_lines(result))
    return (f'<section id="machine"><h2>Machine and commands</h2><dl>{items}</dl>'
            + (f"<details><summary>Commands of the pictures</summary>{commands}</details>"
               if commands else "") + "</section>")


def command_lines(result):
    for scene in result.get("pictures", []):
        for method in scene["methods"]:
            for entry in method["curve"]:
                if "command" in entry:
                    yield entry["command"]
    for scene in result.get("models", []):
        yield scene["truth"]["command"]
        for model in scene["models"]:
            yield model["command"]
