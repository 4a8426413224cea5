"""The diagrams of the page, as SVG."""
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


def regions_plot(places):
    """Relative variances at equal time with their intervals; no mark where a method has not found the mean."""
    with matplotlib.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.6, 3.5), layout="constrained")
        for k, i in enumerate(INTEGRATORS):
            found = [(at, p.variance("time", i)) for at, p in enumerate(places) if p.sampled["time"][i].is_found]
            axes.errorbar([at + 0.16 * (k - 1.5) for at, _ in found], [v.value for _, v in found],
                          yerr=[[v.value - v.low for _, v in found], [v.high - v.value for _, v in found]],
                          fmt=MARKS[i], color=COLORS[i], label=i, markersize=5, elinewidth=1)
        axes.set_yscale("log")
        axes.set_xticks(range(len(places)), [str(p.info["light"]) for p in places])
        for k, plate in enumerate(dict.fromkeys(p.info["plate"] for p in places)):
            at = [j for j, p in enumerate(places) if p.info["plate"] == plate]
            axes.text(sum(at) / len(at), -0.12, f"{plate} plate", ha="center", va="top",
                      transform=axes.get_xaxis_transform())
            if k:
                axes.axvline(at[0] - 0.5, color="#999999", linewidth=0.8)
        axes.set_xlabel("light: 1 is the smallest, 4 the largest", labelpad=26)
        axes.set_ylabel("relative variance of a pixel")
        axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, handletextpad=0.1,
                    columnspacing=1.0)
        return svg(figure, "regions-plot", "Relative variance of each method in the twelve places at equal time, "
                   "logarithmic; the numbers are in the table of 3.3.4")


def convergence_plot(panels):
    """Relative variance against samples a pixel: for each (title, integrator -> points) the curves of all methods, and
    a line for comparison that falls with 1 / samples."""
    with matplotlib.rc_context(STYLE):
        figure, all_axes = plt.subplots((len(panels) + 1) // 2, 2, figsize=(7.6, 2.9 * ((len(panels) + 1) // 2)),
                                        layout="constrained")
        for axes, (title, curves) in zip(all_axes.ravel(), panels):
            drawn = [point for points in curves.values() for point in points]
            for i in INTEGRATORS:
                axes.plot([n for n, _ in curves[i]], [v for _, v in curves[i]], MARKS[i] + "-", color=COLORS[i],
                          label=i, linewidth=1, markersize=4)
            n, highest = [min(drawn)[0], max(drawn)[0]], max(v for _, v in drawn)
            axes.plot(n, [2 * highest, 2 * highest * n[0] / n[1]], "--", color="#555555", linewidth=0.8, label="1/N")
            axes.set_xscale("log", base=2)
            axes.set_yscale("log")
            axes.xaxis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%d"))
            axes.set_title(title, fontsize=9)
        figure.suptitle(" ")  # room for the legend
        figure.legend(*all_axes[0, 0].get_legend_handles_labels(), ncols=5, loc="upper center", frameon=False,
                      columnspacing=1.0)
        for axes in all_axes[-1]:
            axes.set_xlabel("samples a pixel")
        for axes in all_axes[:, 0]:
            axes.set_ylabel("relative variance")
        return svg(figure, "convergence-plot", "Relative variance against samples a pixel, both logarithmic, for "
                           "each method; "
                   "the slopes are in the table below")
