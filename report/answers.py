"""The answers to 3.3.1 to 3.3.4. Every figure comes from the measurement or from predict.py, and the words follow the
figures: where a measured figure contradicts what the exercise says, the text says so."""
import math
from dataclasses import dataclass

from formulas import formula
from measure import FIRST_SEED, INTEGRATORS
from predict import hit_chance, relative_variances, spread
from variance import BUDGETS, half_maximum_angle_deg, highlight_width_px
from words import count, keyed, sig, times, with_interval


@dataclass
class Answers:
    """HTML by question, and the tables beside them."""
    which: str
    materials: str
    plates: list
    worst: str
    predictions: list
    best_of_both: str
    best_of_both_tables: dict


def worst_place(places, integrator):
    """Where a method has its largest relative variance at equal samples, among the places whose mean it found."""
    return max((p for p in places if p.sampled["samples"][integrator].is_found),
               key=lambda p: p.variance("samples", integrator).value)


def name(place):
    return f"the {place.info['plate']} plate under light {place.info['light']}"


def is_place(place, plate, light):
    return place.info["plate"] == plate and place.info["light"] == light


def answer(scene, layout, seeds):
    places = scene.places
    first, last = layout["plates"][0], layout["plates"][-1]
    top = next(p for p in places if is_place(p, first["name"], len(layout["lights"])))
    bottom = next(p for p in places if is_place(p, last["name"], 1))
    exponents = {p["name"]: p["n"] for p in layout["plates"]}
    predictions = predict(scene, exponents, len(layout["lights"]))
    return Answers(which(places, top, bottom), *materials(scene, places, layout),
                   worst(top, bottom, exponents, predictions), predictions, best_of_both(scene, seeds),
                   {budget: variance_rows(scene, budget) for budget in BUDGETS})


def value(place, integrator, budget="samples"):
    return place.variance(budget, integrator).value


def which(places, top, bottom):
    light, direct = worst_place(places, "light"), worst_place(places, "direct")
    text = (f"<p>In the handout's figure, as in ours above: <strong>left: area sampling</strong> of the lights "
            f"(<code>light</code>); <strong>right: directional (BRDF) sampling</strong> "
            f"(<code>direct</code>).</p><p>The two can be told apart by where they fail. Over "
            f"the twelve highlights of our scene, the relative variance of area sampling is largest on {name(light)} "
            f"({sig(value(light, 'light'))}; directional sampling has "
            f"{sig(value(light, 'direct'))} there). That of directional sampling is largest on "
            f"{name(direct)} ({sig(value(direct, 'direct'))}; area sampling has "
            f"{sig(value(direct, 'light'))} there). ")
    if light is top and direct is bottom:
        return text + ("These are the two places that the exercise names, in the top right and in the bottom left, so "
                       "the image with the noise in the top right is area sampling.</p>")
    return text + (f"<strong>This is not quite what the exercise says:</strong> it names {name(top)} for area sampling "
                   f"(measured: {sig(value(top, 'light'))}) and {name(bottom)} for directional sampling "
                   f"(measured: {sig(value(bottom, 'direct'))}).</p>")


def materials(scene, places, layout):
    kd, ks = layout["plates"][0]["kd"], layout["plates"][0]["ks"]
    same = all(p["kd"] == kd and p["ks"] == ks for p in layout["plates"])
    rows = []
    width = scene.reference.shape[1]
    for plate in layout["plates"]:
        region = next(r for r in places if is_place(r, plate["name"], 1))
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
    text += ", ".join(f"{r['name']} {r['n']:,}".replace(",", "\u00a0") for r in rows) + ". "
    if grows:
        text += ("The picture shows it: the same small light 1 is mirrored as a spot that is "
                 + ", ".join(f"{r['measured_px']} pixels wide in the {r['name']} plate" for r in rows)
                 + " (width at half of the maximum, in the reference image). A wider lobe means a smaller exponent, so "
                   "<strong>the top plate is nearly a mirror, the middle one is glossy, and the bottom one is rough"
                   "</strong>. The highlights also grow dimmer as they grow wider: all plates reflect the same share "
                   "of "
                   "the light and only spread it differently.</p>")
    else:
        text += ("<strong>The measured widths do not grow from the top plate to the bottom one</strong> ("
                 + ", ".join(f"{r['name']}: {r['measured_px']} px" for r in rows)
                 + "), so in this picture they cannot be used to tell the exponents.</p>")
    return text, rows


def predict(scene, exponents, lights):
    """What the geometry predicts in each place, beside what was measured."""
    rows = []
    for p in scene.places:
        n, angle_deg = exponents[p.info["plate"]], p.info["half_angle_deg"]
        rows.append({"place": p, "hit": hit_chance(n, angle_deg), "spread": spread(n, angle_deg),
                     "variance": relative_variances(n, angle_deg, lights, scene.methods["samples"]["light"].spp)})
    return rows


def one_in(chance):
    return "nearly every sample" if chance > 0.9 else f"one sample in {sig(1 / chance, 2)}"


def worst(top, bottom, exponents, predictions):
    def hit(p):
        return hit_chance(exponents[p.info["plate"]], p.info["half_angle_deg"])

    def spread_of(p):
        return spread(exponents[p.info["plate"]], p.info["half_angle_deg"])

    def compare(p, bad, good):
        ratio = p.variance("samples", bad).over(p.variance("samples", good))
        return {"worse": f"{times(ratio.value)} the variance of",
                "equal": f"<strong>contrary to the exercise, the same variance within {sig(100 * ratio.within, 2)} % as"
                         f"</strong>",
                "better": f"<strong>contrary to the exercise, only {times(ratio.value)} the variance of</strong>"
                }[ratio.compared]

    text = ("<p>An estimate is noisy where its samples have very different values: most of them small or zero, and a "
            "few "
            "that must make up for them.</p>")
    text += (f"<p><strong>Bottom plate on the left, directional sampling.</strong> The lobe is wide and the light is "
             f"small, so a direction drawn from the lobe seldom meets the light. If <i>θ<sub>l</sub></i> is the angle "
             f"between the middle and the rim of the light, here {sig(bottom.info['half_angle_deg'], 2)}°, a sample of "
             f"the lobe meets it with the chance</p><p class=math>{formula('hit_chance')} &ensp;and then&ensp; "
             f"{formula('hit_variance')}</p><p>for one sample. That is {one_in(hit(bottom))} here; the others return "
             f"black, and those that meet it carry the high radiance of the smallest light. In {name(top)} it is "
             f"{one_in(hit(top))}. Area sampling has no such trouble: every sample aims at a light, and over the small "
             f"light the wide lobe is almost constant. Measured here, directional sampling has "
             f"{compare(bottom, 'direct', 'light')} area sampling.</p>")
    text += (f"<p><strong>Top plate on the right, area sampling.</strong> The points are spread over the whole of the "
             f"large light, but the lobe is so narrow that only those next to the mirror direction return anything, "
             f"and "
             f"those return very much. How uneven the lobe is over the light is told by</p><p class=math>"
             f"{formula('spread')}</p><p>which is {sig(spread_of(top), 2)} here and {sig(spread_of(bottom), 2)} for "
             f"{name(bottom)} (1 means constant). Directional sampling draws from that lobe, so nearly all its samples "
             f"meet the light and have the same value. Measured here, area sampling has "
             f"{compare(top, 'light', 'direct')} directional sampling.</p>")
    ratios = {i: [value(r["place"], i) / r["variance"][i] for r in predictions
                  if r["place"].sampled["samples"][i].is_found] for i in ("light", "direct")}
    text += ("<p>The table has both beside what follows from them for a whole place: the mean over its pixels, also "
             "those "
             "beside the mirror image of the light's middle, divided by the number of samples. Measured is "
             + " and ".join(f"{sig(min(r), 2)} to {sig(max(r), 2)} times of what is predicted for <code>{i}</code>"
                            for i, r in ratios.items())
             + ". They differ because the prediction takes samples as independent, where the renderer's Sobol points "
               "are spread evenly and so do better, the most where nearly all samples have one value; because it knows no "
               "width of a pixel, no diffuse part and no other lights; and because it takes each place as a square and "
               "angles as lengths in a plane, which is roughest for the largest light on the top plate.</p>")
    return text


# --- 3.3.4; each number has a key, by which check_numbers.py recomputes it -----------------------------------------

def key(budget, place, what):
    return f"{budget}/{place.info['plate']}/{place.info['light']}/{what}"


def variance_rows(scene, budget):
    """The table's rows: by place, the methods' relative variances and what averaging and weighting gain or lose."""
    rows = []
    for p in scene.places:
        best = p.best(budget)
        cells = []
        for i in INTEGRATORS:
            found = p.sampled[budget][i].is_found
            cells.append({"text": with_interval(key(budget, p, i), p.variance(budget, i), 2) if found else
                          "mean not found", "best": i in best})
        ratios = [with_interval(key(budget, p, f"{i}/over_best"), p.over_best(budget, i))
                  if p.sampled[budget][i].is_found else "–" for i in ("average", "mis")]
        rows.append({"place": p, "cells": cells, "ratios": ratios,
                     "theory": keyed(key(budget, p, "theory"), p.average_from_theory)})
    return rows


def tally(scene, budget, integrator):
    """"better in 3 of 12, equal within the intervals in 2, worse in 7"."""
    said = [p.over_best(budget, integrator).compared for p in scene.places if p.sampled[budget][integrator].is_found]
    counts = {k: count(f"{budget}/{integrator}/{k}", said.count(k)) for k in ("better", "equal", "worse")}
    missed = len(scene.places) - len(said)
    more = f" (its mean is not found in {count(f'{budget}/{integrator}/not_found', missed)})" if missed else ""
    return (f"better in {counts['better']} of the {count('places', len(scene.places))} places, not to be told from "
            f"it in "
            f"{counts['equal']}, worse in {counts['worse']}{more}")


def largest_loss(scene, budget, integrator):
    """The place where a method is worst against the better one of the two, and that ratio."""
    p = max((p for p in scene.places if p.sampled[budget][integrator].is_found),
            key=lambda p: p.over_best(budget, integrator).value)
    return p, p.over_best(budget, integrator)


def loss_words(scene, budget, integrator):
    place, ratio = largest_loss(scene, budget, integrator)
    return f"× {with_interval(f'{budget}/{integrator}/largest_loss', ratio)} ({name(place)})"


def best_of_both(scene, seeds):
    places = scene.places
    never_better = all(p.over_best("time", "average").compared != "better" for p in places)
    always_better = all(p.over_best("time", "average").compared == "better" for p in places)
    verdict = "By these figures, yes." if always_better else "No." if never_better else "Hardly."
    text = (f"<p><strong>{verdict}</strong> The average of two unbiased images is unbiased too. With the same number "
            f"of "
            f"samples from each, and both independent,</p><p class=math>{formula('average')}</p><p>so wherever one "
            f"method "
            f"is much worse than the other, the average keeps a quarter of the <em>larger</em> variance, however "
            f"good the "
            f"other method is: half of the worse image's noise stays. The average here has samples of its own, none of "
            f"them from the other two images, so that this can be tested: its measured variance is between "
            f"{theory_range(places)} of what the formula says.</p>")
    text += compared_words(scene, seeds)
    text += (f"<p>That averaging cannot win at equal cost is seen without measuring: with half of the samples from "
             f"each,"
             f"</p><p class=math>{formula('average_cost')}</p><p>which is the plain mean of the two variances (as "
             f"long as "
             f"variance falls with 1/<i>N</i>) and so <em>never</em> less than the smaller one. The average only "
             f"avoids "
             f"having the worst place of one image alone: it has a smaller version of both artefacts.</p>")
    text += (f"<p>What helps is to weight each <em>sample</em>, not each image: multiple importance sampling (Veach "
             f"and "
             f"Guibas), here with the balance heuristic and one sample from each method,</p><p class=math>"
             f"{formula('mis')}</p><p class=math>{formula('mis_weight')}</p><p>where both densities are per solid "
             f"angle. A "
             f"sample that the other method would have drawn far more often gets a small weight, so the rare large "
             f"values "
             f"that make the noise mostly vanish. {mis_words(scene)}</p>")
    return text + f"<p>{whole_image(scene)}</p>"


def theory_range(places):
    ratios = [value(p, "average") / p.average_from_theory for p in places]
    return f"{keyed('samples/theory/low', min(ratios))} and {keyed('samples/theory/high', max(ratios))} times"


def compared_words(scene, seeds):
    """The average and MIS against the better one of the two single methods, at equal samples and at equal time."""
    spp = {i: count(f"time/spp/{i}", scene.methods["time"][i].spp) for i in INTEGRATORS}
    seconds = {i: with_interval(f"time/seconds/{i}", scene.methods["time"][i].seconds) for i in INTEGRATORS}
    text = (f"<p><strong>Equal samples</strong> ({count('samples/spp', scene.methods['samples']['light'].spp)} a "
            f"pixel). "
            f"This flatters <code>average</code> and <code>mis</code> alike: each of their samples is one of the light "
            f"<em>and</em> one of the BSDF, so they take twice as many in all. Against the better one of "
            f"<code>light</code> "
            f"and <code>direct</code>, the average is {tally(scene, 'samples', 'average')}; <code>mis</code> is "
            f"{tally(scene, 'samples', 'mis')}. At worst the average has {loss_words(scene, 'samples', 'average')} its "
            f"variance, <code>mis</code> {loss_words(scene, 'samples', 'mis')}.</p>")
    text += ("<p><strong>Equal time</strong>. With "
             + ", ".join(f"{spp[i]} samples a pixel of <code>{i}</code> ({seconds[i]} s)" for i in INTEGRATORS)
             + f" of processor time, the average is {tally(scene, 'time', 'average')}; <code>mis</code> is "
               f"{tally(scene, 'time', 'mis')}. At worst the average has {loss_words(scene, 'time', 'average')} the "
               f"variance of the better one, <code>mis</code> {loss_words(scene, 'time', 'mis')}.</p>")
    return text + (f"<p>In brackets are 95 % intervals, from {count('seeds', seeds)} independent seeds of each method; "
                   f"“not to be told” means that the interval of the ratio has one in it. Where the variance itself "
                   f"is made by "
                   f"rare large values, seeds that all missed them make it look too small and too certain.</p>")


def best_of_both_sentence(scene):
    """The result in one sentence, for the head of the page."""
    _, mis = largest_loss(scene, "time", "mis")
    _, average = largest_loss(scene, "time", "average")
    return (f"Each method fails where the other is good; in the same processor time multiple importance sampling has "
            f"at most "
            f"{with_interval('time/mis/largest_loss', mis)} times the variance of the better one in each of the "
            f"{count('places', len(scene.places))} mirror images, and the average of the two images up to "
            f"{with_interval('time/average/largest_loss', average)} times (in brackets: 95 % intervals).")


def mis_words(scene):
    """The honest sum: how far MIS is from the best, and the average."""
    said = [p.over_best("time", "mis").compared for p in scene.places]
    _, mis = largest_loss(scene, "time", "mis")
    _, average = largest_loss(scene, "time", "average")
    text = ("Where one method does nearly all of the work, the other's samples are time lost, so at equal time it "
            "does not "
            "always beat the better one" if "worse" in said else
            "At equal time it is nowhere clearly worse than the better one of the two methods")
    return (f"{text}. Its strength is that it is <strong>never far from the best</strong>, without anybody knowing "
            f"which "
            f"that is: at most × {with_interval('time/mis/largest_loss', mis)} its variance, where the average has "
            f"up to × "
            f"{with_interval('time/average/largest_loss', average)}.")


def whole_image(scene):
    """MIS against the others in all pixels but those of the lights, at equal time."""
    parts = []
    for i in ("light", "direct", "average"):
        if not scene.lit.sampled["time"][i].is_found:
            parts.append(f"<code>{i}</code> has not found the mean")
            continue
        ratio = scene.lit.variance("time", i).over(scene.lit.variance("time", "mis"))
        tie = ", not to be told from it" if ratio.compared == "equal" else ""
        parts.append(f"<code>{i}</code> has × {with_interval(f'time/lit/{i}/over_mis', ratio)}{tie}")
    return ("Over the whole image but the strip with the lights, at equal time and against the variance of "
            f"<code>mis</code>: {'; '.join(parts)}.")
