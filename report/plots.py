"""The two diagrams of the page, as SVG."""
import io
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from measure import INTEGRATORS  # noqa: E402

COLORS = {"light": "#0072b2", "direct": "#d55e00", "average": "#7f7f7f", "mis": "#009e73"}
MARKS = {"light": "o", "direct": "s", "average": "D", "mis": "^"}
STYLE = {"svg.fonttype": "path", "font.size": 9, "axes.spines.top": False, "axes.spines.right": False,
         "font.family": "DejaVu Sans", "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True}


def svg(figure, name, spoken):
    with matplotlib.rc_context({"svg.hashsalt": name}):
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None})
    plt.close(figure)
    text = out.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    text = re.sub(r'id="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r'(href="|url\()#([^")]+)', rf'\1#{name}-\2', text)
    text = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", text, count=1)
    return re.sub(r'(<svg[^>]*?) width="[^"]*"', rf'\1 class="plot" role="img" aria-label="{spoken}"', text, count=1)


def regions_plot(regions):
    with matplotlib.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.6, 3.5), layout="constrained")
        for i in INTEGRATORS:
            axes.plot(range(len(regions)), [r.relative_variance[i] for r in regions], MARKS[i], color=COLORS[i],
                      label=i, markersize=6)
        axes.plot(range(len(regions)), [r.average_from_theory for r in regions], "_", color="black", markersize=12,
                  label="(light + direct) / 4")
        axes.set_yscale("log")
        axes.set_xticks(range(len(regions)), [str(r.info["light"]) for r in regions])
        for k, plate in enumerate(dict.fromkeys(r.info["plate"] for r in regions)):
            at = [j for j, r in enumerate(regions) if r.info["plate"] == plate]
            axes.text(sum(at) / len(at), -0.12, f"{plate} plate", ha="center", va="top",
                      transform=axes.get_xaxis_transform())
            if k:
                axes.axvline(at[0] - 0.5, color="#999999", linewidth=0.8)
        axes.set_xlabel("light: 1 is the smallest, 4 the largest", labelpad=26)
        axes.set_ylabel("relative variance of a pixel")
        axes.legend(ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, handletextpad=0.1,
                    columnspacing=1.0)
        return svg(figure, "regions-plot", "Relative variance of each method in the twelve highlights, logarithmic; the "
                   "numbers are in the table below")


def time_plot(scenes):
    """Error against render time: a point for each measured render, and a line where variance is 1 / time."""
    with matplotlib.rc_context(STYLE):
        figure, all_axes = plt.subplots(1, len(scenes), figsize=(7.6, 3.1), layout="constrained")
        for axes, (title, scene) in zip(all_axes, scenes):
            for i in INTEGRATORS:
                m, t = scene.methods[i], scene.equal_time[i]
                points = sorted([(m.seconds, m.relative_variance_stderr ** 0.5),
                                 (t.seconds, t.relative_variance ** 0.5)])
                axes.plot(*zip(*points), MARKS[i] + "-", color=COLORS[i], label=i, linewidth=1, markersize=5)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_title(title, fontsize=9)
            axes.set_xlabel("render time in s")
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
                axis.set_minor_formatter(matplotlib.ticker.FormatStrFormatter("%.2g"))
            axes.tick_params(which="minor", labelsize=7)
            axes.xaxis.set_minor_locator(matplotlib.ticker.LogLocator(subs=(2, 5)))
            axes.yaxis.set_minor_locator(matplotlib.ticker.LogLocator(subs=(2, 5)))
        all_axes[0].set_ylabel("relative standard error")
        all_axes[0].legend(frameon=False)
        return svg(figure, "time-plot", "Relative standard error against render time at equal samples and at equal time; "
                   "the numbers are in the tables above")
