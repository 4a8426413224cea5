"""Formulas as inline SVG, drawn by matplotlib's mathtext, with their source as the spoken text."""
import html
import io
import re

import matplotlib

matplotlib.use("Agg")
from matplotlib import font_manager, mathtext  # noqa: E402

from images import data_uri  # noqa: E402

FORMULAS = {
    "hemisphere": (r"$L_r(\mathbf{x},\omega_r)=\int_{H^2} f_r(\mathbf{x},\omega_i,\omega_r)\,L_i(\mathbf{x},\omega_i)"
                   r"\,\cos\theta_i\,d\omega_i$",
                   "L r of x and omega r is the integral over the hemisphere of f r times L i times cosine theta i, "
                   "d omega i"),
    "surface": (r"$L_r(\mathbf{x}',\mathbf{x})=\int_A f_r(\mathbf{x}'',\mathbf{x}',\mathbf{x})\,"
                r"L_e(\mathbf{x}'',\mathbf{x}')\,V(\mathbf{x}'',\mathbf{x}')\,"
                r"\dfrac{\cos\theta''\cos\theta'}{\Vert\mathbf{x}''-\mathbf{x}'\Vert^2}\,dA(\mathbf{x}'')$",
                "L r from x prime to x is the integral over the lights' surfaces of f r times L e times V times cosine "
                "theta double prime times cosine theta prime over the squared distance, d A of x double prime"),
    "estimator": (r"$\dfrac{1}{N}\sum_{j=1}^{N}\dfrac{f_r\,L_e\,V\,\cos\theta''\,\cos\theta'\;/\;"
                  r"\Vert\mathbf{x}''_j-\mathbf{x}'\Vert^2}{p(\mathbf{x}''_j)}$",
                  "one over N times the sum over j of f r L e V cosine theta double prime cosine theta prime over "
                  "squared distance, divided by p of x double prime j"),
    "density": (r"$p(\mathbf{x}'')=\dfrac{1}{n_{\mathrm{lights}}}\cdot\dfrac{1}{A_{\mathrm{light}}}$",
                "p of x double prime is one over the number of lights times one over the area of the chosen light"),
    "sample_lights": (r"$L_e(\mathbf{x}'',\mathbf{x}')\,V(\mathbf{x}'',\mathbf{x}')\,"
                      r"\dfrac{\cos\theta''}{\Vert\mathbf{x}''-\mathbf{x}'\Vert^2\;p(\mathbf{x}'')}$",
                      "L e times V times cosine theta double prime over squared distance times p of x double prime"),
    "solid_angle": (r"$p_\omega=p(\mathbf{x}'')\,\dfrac{\Vert\mathbf{x}''-\mathbf{x}'\Vert^2}{\cos\theta''}$",
                    "p omega is p of x double prime times squared distance over cosine theta double prime"),
    "phong": (r"$f_r=\dfrac{k_d}{\pi}+k_s\,\dfrac{n+2}{2\pi}\,\cos^n\alpha$",
              "f r is k d over pi plus k s times n plus two over two pi times cosine to the n of alpha"),
    "hit_chance": (r"$P=1-\cos^{n+1}\theta_l$",
                   "P is one minus cosine to the n plus one of theta l"),
    "hit_variance": (r"$\dfrac{\mathrm{Var}}{\mathrm{mean}^2}=\dfrac{1-P}{P}$",
                     "variance over squared mean is one minus P over P"),
    "spread": (r"$\dfrac{E[f^2]}{E[f]^2}=\dfrac{(n+1)^2\,(1-c)\,(1-c^{2n+1})}{(2n+1)\,(1-c^{n+1})^2},"
               r"\quad c=\cos\theta_l$",
               "the mean of f squared over the squared mean of f is n plus one squared times one minus c times one "
               "minus c to the two n plus one, over two n plus one times the square of one minus c to the n plus one, "
               "with c the cosine of theta l"),
    "average": (r"$\mathrm{Var}\left[\frac{A+B}{2}\right]=\dfrac{\mathrm{Var}\,A+\mathrm{Var}\,B}{4}$",
                "the variance of A plus B over two is variance A plus variance B, over four"),
    "average_cost": (r"$\mathrm{Var}\left[\dfrac{A_{N/2}+B_{N/2}}{2}\right]="
                     r"\dfrac{2\,\mathrm{Var}\,A+2\,\mathrm{Var}\,B}{4}=\dfrac{\mathrm{Var}\,A+\mathrm{Var}\,B}{2}$",
                     "with half the samples from each, the variance of the average is the mean of the two variances"),
    "mis": (r"$\hat{L}=w_A(\omega_A)\,\dfrac{f(\omega_A)}{p_A(\omega_A)}+w_B(\omega_B)\,\dfrac{f(\omega_B)}"
            r"{p_B(\omega_B)},$",
            "the estimate is w A of omega A times f over p A, plus w B of omega B times f over p B"),
    "mis_weight": (r"$w_A(\omega)=\dfrac{p_A(\omega)}{p_A(\omega)+p_B(\omega)},\quad w_B=1-w_A$",
                   "w A is p A over p A plus p B; w B is one minus w A"),
    "relative_variance": (r"$v=\dfrac{\mathrm{mean\ over\ pixels\ of\ Var}}{(\mathrm{mean\ luminance})^2}$",
                          "v is the mean over pixels of the variance, over the squared mean luminance"),
}


def formula(name):
    """An <svg> whose height is in em, so that it grows with the text around it; its colour is the text's."""
    source, spoken = FORMULAS[name]
    with matplotlib.rc_context({"mathtext.fontset": "cm", "svg.fonttype": "path", "svg.hashsalt": name}):
        out = io.BytesIO()
        mathtext.math_to_image(source, out, prop=font_manager.FontProperties(size=10), dpi=72, format="svg")
    svg = out.getvalue().decode()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'<g id="patch_1">.*?</g>', "", svg, count=1, flags=re.S)  # the white ground
    # ids are unique in the whole page
    svg = re.sub(r'id="([^"]+)"', rf'id="{name}-\1"', svg)
    svg = re.sub(r'href="#([^"]+)"', rf'href="#{name}-\1"', svg)
    width, height = (float(x) for x in re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg).groups())
    svg = re.sub(r'<svg [^>]*>', f'<svg class="formula" role="img" aria-label="{html.escape(spoken)}" '
                 f'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
                 f'style="width:{width / 10:.2f}em;height:{height / 10:.2f}em" viewBox="0 0 {width:g} {height:g}">',
                 svg, count=1)
    return svg


def as_image(svg):
    """The same inline <svg> as an <img>: weasyprint 57 draws no glyphs in inline ones."""
    start = svg[:svg.index(">")]
    kept = " ".join(re.findall(r' ((?:class|style)="[^"]*")', start))
    spoken = re.search(r'aria-label="([^"]*)"', start).group(1)
    alone = svg if "xmlns=" in start else svg.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)
    return f'<img {kept} alt="{spoken}" src="{data_uri(alone.encode(), "svg+xml")}">'
