"""The answers to 3.3.1 to 3.3.4. Every figure comes from the measurement, and the words follow the figures: where a
measured figure contradicts what the exercise says, the text says so."""
import math
from dataclasses import dataclass

from formulas import formula
from measure import INTEGRATORS
from variance import half_maximum_angle_deg, highlight_width_px


def sig(value, digits=3):
    """A number with so many significant digits, without an exponent where it stays readable."""
    if value == 0:
        return "0"
    if abs(value) < 1e-4 or abs(value) >= 1e6:
        base, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{base} · 10<sup>{int(exponent)}</sup>".replace("-", "−")
    rounded = float(f"{value:.{digits - 1}e}")
    places = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:,.{places}f}".replace(",", " ").replace("-", "−")


def times(ratio):
    """"3.2 times"."""
    return f"{sig(ratio, 2)} times"


@dataclass
class Answers:
    """HTML by question, and the tables beside them."""
    which: str
    materials: str
    plates: list
    worst: str
    chances: list
    best_of_both: str


def worst_region(regions, integrator):
    return max(regions, key=lambda r: r.relative_variance[integrator])


def place(region):
    return f"the {region.info['plate']} plate under light {region.info['light']}"


def is_place(region, plate, light):
    return region.info["plate"] == plate and region.info["light"] == light


def hit_chance(n, half_angle_deg):
    """Chance that a sample of the Phong lobe meets a round light in the mirror direction."""
    return 1 - math.cos(math.radians(half_angle_deg)) ** (n + 1)


def spread(n, half_angle_deg):
    """E[f^2] / E[f]^2 of cos^n over a round light in the mirror direction."""
    c = math.cos(math.radians(half_angle_deg))
    return (n + 1) ** 2 * (1 - c) * (1 - c ** (2 * n + 1)) / ((2 * n + 1) * (1 - c ** (n + 1)) ** 2)


def answer(scene, regions, layout):
    first, last = layout["plates"][0], layout["plates"][-1]
    smallest, largest = 1, len(layout["lights"])
    top = next(r for r in regions if is_place(r, first["name"], largest))
    bottom = next(r for r in regions if is_place(r, last["name"], smallest))
    exponents = {p["name"]: p["n"] for p in layout["plates"]}
    return Answers(which(regions, top, bottom), *materials(scene, regions, layout),
                   worst(regions, top, bottom, exponents), chances(regions, exponents), best_of_both(scene, regions))


def which(regions, top, bottom):
    light, direct = worst_region(regions, "light"), worst_region(regions, "direct")
    text = (f"<p><strong>Left: area sampling</strong> of the lights (<code>light</code>). <strong>Right: directional "
            f"(BRDF) sampling</strong> (<code>direct</code>).</p><p>The two can be told apart by where they fail. Over "
            f"the twelve highlights of our scene, the relative variance of area sampling is largest on {place(light)} "
            f"({sig(light.relative_variance['light'])}; directional sampling has "
            f"{sig(light.relative_variance['direct'])} there). That of directional sampling is largest on "
            f"{place(direct)} ({sig(direct.relative_variance['direct'])}; area sampling has "
            f"{sig(direct.relative_variance['light'])} there). ")
    if light is top and direct is bottom:
        return text + ("These are the two places that the exercise names, in the top right and in the bottom left, so "
                       "the image with the noise in the top right is area sampling.</p>")
    return text + (f"<strong>This is not quite what the exercise says:</strong> it names {place(top)} for area sampling "
                   f"(measured: {sig(top.relative_variance['light'])}) and {place(bottom)} for directional sampling "
                   f"(measured: {sig(bottom.relative_variance['direct'])}).</p>")


def materials(scene, regions, layout):
    kd, ks = layout["plates"][0]["kd"], layout["plates"][0]["ks"]
    same = all(p["kd"] == kd and p["ks"] == ks for p in layout["plates"])
    rows = []
    width = scene.reference.shape[1]
    for plate in layout["plates"]:
        region = next(r for r in regions if is_place(r, plate["name"], 1))
        rect = region.info["rect"]
        # the rectangle is as wide as the light's rim and the lobe's half-maximum angle together
        lobe_deg, light_deg = math.degrees(math.acos(0.5 ** (1 / plate["n"]))), region.info["half_angle_deg"]
        half_deg = half_maximum_angle_deg(plate["n"], light_deg)
        rows.append({"name": plate["name"], "n": plate["n"],
                     "half_lobe_deg": lobe_deg,
                     "expected_px": round((rect[2] - rect[0]) * width * half_deg / (light_deg + lobe_deg)),
                     "measured_px": highlight_width_px(scene, rect)})
    measured = [r["measured_px"] for r in rows]
    grows = all(a < b for a, b in zip(measured, measured[1:]))
    text = ("<p>All three are Phong materials, a diffuse part and a lobe around the mirror direction:</p>"
            f"<p class=math>{formula('phong')}</p>")
    text += ("<p>They have the same colours" if same else "<p>They differ in their colours")
    text += (f" (<i>k<sub>d</sub></i> about {sig(sum(kd) / 3, 2)}, <i>k<sub>s</sub></i> about {sig(sum(ks) / 3, 2)}: "
             "much more gloss than diffuse reflection) and differ in the exponent <i>n</i>: ")
    text += ", ".join(f"{r['name']} {r['n']:,}".replace(",", " ") for r in rows) + ". "
    if grows:
        text += ("The picture shows it: the same small light 1 is mirrored as a spot that is "
                 + ", ".join(f"{r['measured_px']} pixels wide in the {r['name']} plate" for r in rows)
                 + " (width at half of the maximum, in the reference image). A wider lobe means a smaller exponent, so "
                   "<strong>the top plate is nearly a mirror, the middle one is glossy, and the bottom one is rough"
                   "</strong>. The highlights also grow dimmer as they grow wider: all plates reflect the same share of "
                   "the light and only spread it differently.</p>")
    else:
        text += ("<strong>The measured widths do not grow from the top plate to the bottom one</strong> ("
                 + ", ".join(f"{r['name']}: {r['measured_px']} px" for r in rows)
                 + "), so in this picture they cannot be used to tell the exponents.</p>")
    return text, rows


def chances(regions, exponents):
    return [{"region": r, "hit": hit_chance(exponents[r.info["plate"]], r.info["half_angle_deg"]),
             "spread": spread(exponents[r.info["plate"]], r.info["half_angle_deg"])} for r in regions]


def one_in(chance):
    return "nearly every sample" if chance > 0.9 else f"one sample in {sig(1 / chance, 2)}"


def worst(regions, top, bottom, exponents):
    def hit(r):
        return hit_chance(exponents[r.info["plate"]], r.info["half_angle_deg"])

    def spread_of(r):
        return spread(exponents[r.info["plate"]], r.info["half_angle_deg"])

    def compare(r, bad, good):
        ratio = r.relative_variance[bad] / r.relative_variance[good]
        return (f"{times(ratio)} the variance of" if ratio > 1 else
                f"<strong>contrary to the exercise, only {sig(ratio, 2)} times the variance of</strong>")

    text = ("<p>An estimate is noisy where its samples have very different values: most of them small or zero, and a few "
            "that must make up for them.</p>")
    text += (f"<p><strong>Bottom plate on the left, directional sampling.</strong> The lobe is wide and the light is "
             f"small, so a direction drawn from the lobe seldom meets the light. If <i>θ<sub>l</sub></i> is the angle "
             f"between the middle and the rim of the light, here {sig(bottom.info['half_angle_deg'], 2)}°, a sample of "
             f"the lobe meets it with the chance</p><p class=math>{formula('hit_chance')} &ensp;and then&ensp; "
             f"{formula('hit_variance')}</p><p>for one sample. That is {one_in(hit(bottom))} here; the others return "
             f"black, and those that meet it carry the high radiance of the smallest light. In {place(top)} it is "
             f"{one_in(hit(top))}. Area sampling has no such trouble: every sample aims at a light, and over the small "
             f"light the wide lobe is almost constant. Measured here, directional sampling has "
             f"{compare(bottom, 'direct', 'light')} area sampling.</p>")
    text += (f"<p><strong>Top plate on the right, area sampling.</strong> The points are spread over the whole of the "
             f"large light, but the lobe is so narrow that only those next to the mirror direction return anything, and "
             f"those return very much. How uneven the lobe is over the light is told by</p><p class=math>"
             f"{formula('spread')}</p><p>which is {sig(spread_of(top), 2)} here and {sig(spread_of(bottom), 2)} for "
             f"{place(bottom)} (1 means constant). Directional sampling draws from that lobe, so nearly all its samples "
             f"meet the light and have the same value. Measured here, area sampling has "
             f"{compare(top, 'light', 'direct')} directional sampling.</p>")
    return text


def best_of_both(scene, regions):
    total = len(regions)
    beats_both = [r for r in regions if r.relative_variance["average"] < r.best_single]
    mis_better = [r for r in regions if r.relative_variance["mis"] < r.relative_variance["average"]]
    mis_near_best = [r for r in regions if r.relative_variance["mis"] <= 1.1 * r.best_single]
    loss = max(regions, key=lambda r: r.relative_variance["average"] / r.best_single)
    gain = max(regions, key=lambda r: r.relative_variance["average"] / r.relative_variance["mis"])
    mis_loss = max(regions, key=lambda r: r.relative_variance["mis"] / r.best_single)
    deviation = max(abs(r.relative_variance["average"] / r.average_from_theory - 1) for r in regions)
    direct_worst, light_worst = worst_region(regions, "direct"), worst_region(regions, "light")
    inherits = max(r.relative_variance["average"] / max(r.relative_variance["light"], r.relative_variance["direct"])
                   for r in regions)
    m = scene.methods
    verdict = "No." if len(beats_both) < total else "By these figures, yes."
    text = (f"<p><strong>{verdict}</strong> The average of two unbiased images is unbiased too. With the same number of "
            f"samples from each, and both independent,</p><p class=math>{formula('average')}</p><p>so wherever one method "
            f"is much worse than the other, the average keeps a quarter of the <em>larger</em> variance, however good the "
            f"other method is: half of the worse image's noise stays. ")
    if len(beats_both) == 0:
        text += f"In none of the {total} highlights is the average better than the better one of the two images. "
    else:
        text += (f"The average is better than both images in {len(beats_both)} of the {total} highlights; that needs the "
                 f"worse variance to be less than three times the better one. ")
    text += (f"At worst it has {times(loss.relative_variance['average'] / loss.best_single)} the variance of the better "
             f"image ({place(loss)}). The measured variances of the average agree with the formula within "
             f"{sig(100 * deviation, 2)} %, and it keeps at most {sig(100 * inherits, 2)} % of the larger variance.</p>")
    text += (f"<p>The average also costs both methods' samples: {sig(m['average'].seconds, 2)} s against "
             f"{sig(m['light'].seconds, 2)} s (<code>light</code>) and {sig(m['direct'].seconds, 2)} s "
             f"(<code>direct</code>) here. With half of the samples from each, for about the cost of one image,</p>"
             f"<p class=math>{formula('average_cost')}</p><p>it is the plain mean of the two variances (as long as variance "
             f"falls with 1/<i>N</i>) and so <em>never</em> better than the better image. It only avoids having the worst place of one image alone: it has a "
             f"smaller version of both artefacts ({place(light_worst)}: {sig(light_worst.relative_variance['average'])}; "
             f"{place(direct_worst)}: {sig(direct_worst.relative_variance['average'])}).</p>")
    text += (f"<p>What helps is to weight each <em>sample</em>, not each image: multiple importance sampling (Veach and "
             f"Guibas 1995), here with the balance heuristic and one sample from each method,</p><p class=math>"
             f"{formula('mis')}</p><p>where both densities are per solid angle. A sample that the other method would have "
             f"drawn far more often gets a small weight, so the rare large values that make the noise mostly vanish. ")
    if len(mis_better) == total:
        text += f"It beats the average in all {total} highlights, "
    elif mis_better:
        text += f"It beats the average in {len(mis_better)} of {total} highlights, "
    else:
        text += "<strong>In our measurement it beats the average nowhere</strong>, "
    text += (f"by up to {times(gain.relative_variance['average'] / gain.relative_variance['mis'])} ({place(gain)}). It is "
             f"as good as the better single method, or better, in {len(mis_near_best)} of {total} (within 10 %); at worst "
             f"it has {times(mis_loss.relative_variance['mis'] / mis_loss.best_single)} the variance of the better one "
             f"({place(mis_loss)}).")
    text += whole_image(m) + "</p>"
    return text


def whole_image(methods):
    best = max(INTEGRATORS, key=lambda i: methods[i].efficiency)
    mis, average = methods["mis"], methods["average"]
    text = (f" Over the whole image, time included, the efficiency of <code>mis</code> is "
            f"{times(mis.efficiency / average.efficiency)} that of the average, and "
            f"{times(mis.efficiency_trimmed / average.efficiency_trimmed)} without the worst 0.1 % of pixels")
    if best == "mis":
        return text + "; it is the best of the four."
    return text + f"; the most efficient of the four, all pixels counted, is <code>{best}</code> here."
