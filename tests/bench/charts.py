"""All charts, as SVG and PNG. Needs matplotlib. error-over-time.png is the one that the READMEs show:
copy it beside this file."""

import picture_plots
import plots


def draw(result, folder):
    """Writes the charts of what was measured."""
    about = result["about"]
    note = (f"{about['processor']}, one core at {about['clockHertz'] / 1e9:.1f} GHz, "
            f"{about['commit']}")
    for part, name, make in (
            ("pictures", "error-over-time", picture_plots.error_over_time),
            ("models", "models", picture_plots.model_errors),
            ("scenes", "receiver-error-over-time", plots.error_over_time),
            ("scenes", "time-over-tolerance", plots.time_over_tolerance),
            ("scenes", "tolerance-kept", plots.tolerance_kept),
            ("scaling", "scaling", plots.scaling),
            ("frame", "frame", plots.frame)):
        if result.get(part):
            save(make(result[part]), note, folder / name)


def save(figure, note, path):
    figure.text(0.995, 0.005, note, ha="right", va="bottom", fontsize=6.5, color="#777777")
    # No date: the same figures give the same bytes.
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})
    figure.savefig(path.with_suffix(".png"), dpi=160)
    plots.plt.close(figure)
