// Shows the measured images in place: one view (zoom, position, exposure) for all methods. No dependencies.
"use strict";

(() => {
  const WEIGHTS = [0.212671, 0.715160, 0.072169];
  const METHODS = ["light", "direct", "average", "mis", "reference"];
  const VIEWS = ["image", "error", "difference"];
  const BLINK_MS = 700;

  // --- data ------------------------------------------------------------------------------------------------------

  /** Undoes pack() of images.py: luminance 2^(code/64 - 16), shares of red and green, standard error
   *  2^(code/4 - 20). */
  async function decode(uri, width, height) {
    const image = new Image();
    image.src = uri;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = 5 * height;
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const bytes = context.getImageData(0, 0, width, 5 * height).data;
    const n = width * height;
    const rgb = new Float32Array(3 * n);
    const error = new Float32Array(n);
    for (let i = 0; i < n; ++i) {
      const code = bytes[4 * i] * 256 + bytes[4 * (i + n)];
      const errorCode = bytes[4 * (i + 4 * n)];
      error[i] = errorCode ? 2 ** (errorCode / 4 - 20) : 0;
      if (!code) continue;
      const red = bytes[4 * (i + 2 * n)] / 255;
      const green = bytes[4 * (i + 3 * n)] / 255;
      const blue = Math.max(0, 1 - red - green);
      const scale = 2 ** (code / 64 - 16) / (WEIGHTS[0] * red + WEIGHTS[1] * green + WEIGHTS[2] * blue);
      rgb[3 * i] = red * scale;
      rgb[3 * i + 1] = green * scale;
      rgb[3 * i + 2] = blue * scale;
    }
    return { rgb, error };
  }

  const srgbTable = new Uint8ClampedArray(4096);
  for (let i = 0; i < 4096; ++i) {
    const v = (i / 4095) ** 2; // finer steps in the dark
    srgbTable[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
  }
  const srgb = (v) => srgbTable[v >= 1 ? 4095 : v <= 0 ? 0 : Math.round(Math.sqrt(v) * 4095)];
  const luminance = (rgb, i) => WEIGHTS[0] * rgb[3 * i] + WEIGHTS[1] * rgb[3 * i + 1] + WEIGHTS[2] * rgb[3 * i + 2];
  const number = (v) =>
    (v === 0 ? "0" : Math.abs(v) >= 100 || Math.abs(v) < 0.001 ? v.toExponential(2) : v.toPrecision(3));

  class Viewer {
    constructor(root) {
      this.root = root;
      this.name = root.dataset.scene;
      this.data = JSON.parse(document.getElementById(`data-${this.name}`).textContent);
      this.decoded = new Map();
      this.painted = new Map();
      this.state = { method: "light", against: "direct", budget: "samples", view: "image", exposure: 0, zoom: 1, x: 0.5,
                     y: 0.5, split: -1, blink: false };
      this.canvas = root.querySelector("canvas");
      this.readout = root.querySelector(".readout");
      this.pointers = new Map();
      this.blinkPhase = false;
      this.connect();
      this.fromHash();
      this.update();
    }

    $(selector) { return this.root.querySelector(selector); }

    // --- controls ------------------------------------------------------------------------------------------------

    connect() {
      for (const group of ["method", "budget", "view"])
        for (const button of this.root.querySelectorAll(`[data-${group}]`))
          button.addEventListener("click", () => this.set({ [group]: button.dataset[group] }));
      this.$(".against").addEventListener("change", (e) => this.set({ against: e.target.value }));
      this.$(".exposure").addEventListener("input", (e) => this.set({ exposure: Number(e.target.value) }));
      this.$(".blink").addEventListener("click", () => this.set({ blink: !this.state.blink, split: -1 }));
      this.$(".split").addEventListener("click", () =>
        this.set({ split: this.state.split < 0 ? 0.5 : -1, blink: false }));
      this.$(".divider").addEventListener("input", (e) => this.set({ split: Number(e.target.value) }));
      this.$(".zoom-in").addEventListener("click", () => this.zoomAt(2, 0.5, 0.5));
      this.$(".zoom-out").addEventListener("click", () => this.zoomAt(0.5, 0.5, 0.5));
      this.$(".fit").addEventListener("click", () => this.set({ zoom: 1, x: 0.5, y: 0.5 }));
      this.root.addEventListener("keydown", (e) => this.key(e));
      const c = this.canvas;
      c.addEventListener("wheel", (e) => {
        if (!e.ctrlKey && document.activeElement !== c) return;  // the page scrolls
        e.preventDefault();
        const p = this.fraction(e);
        this.zoomAt(2 ** (-e.deltaY / (e.deltaMode ? 6 : 240)), p.x, p.y);
      }, { passive: false });
      c.addEventListener("pointerdown", (e) => {
        c.focus({ preventScroll: true });
        c.setPointerCapture(e.pointerId);
        this.pointers.set(e.pointerId, this.fraction(e));
        const near = this.state.split >= 0 && Math.abs(this.fraction(e).x - this.state.split) * c.clientWidth < 22;
        this.dragsDivider = near && this.pointers.size === 1;
      });
      c.addEventListener("pointermove", (e) => this.pointerMoved(e));
      for (const end of ["pointerup", "pointercancel"])
        c.addEventListener(end, (e) => { this.pointers.delete(e.pointerId); this.dragsDivider = false; });
      c.addEventListener("pointerleave", () => this.say(null));
      c.addEventListener("dblclick", (e) => { const p = this.fraction(e); this.zoomAt(2, p.x, p.y); });
      new ResizeObserver(() => this.draw()).observe(c);
      setInterval(() => {
        if (!this.state.blink) return;
        this.blinkPhase = !this.blinkPhase;
        this.draw();
      }, BLINK_MS);
    }

    key(e) {
      if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT") return;
      const s = this.state;
      const step = 0.1 / s.zoom;
      const onRange = e.target.type === "range";
      const actions = {
        b: () => this.set({ blink: !s.blink, split: -1 }),
        s: () => this.set({ split: s.split < 0 ? 0.5 : -1, blink: false }),
        v: () => this.set({ view: VIEWS[(VIEWS.indexOf(s.view) + 1) % VIEWS.length] }),
        t: () => this.set({ budget: s.budget === "time" ? "samples" : "time" }),
        e: () => this.set({ exposure: Math.max(-8, s.exposure - 0.5) }),
        E: () => this.set({ exposure: Math.min(8, s.exposure + 0.5) }),
        "+": () => this.zoomAt(2, 0.5, 0.5), "=": () => this.zoomAt(2, 0.5, 0.5), "-": () => this.zoomAt(0.5, 0.5, 0.5),
        0: () => this.set({ zoom: 1, x: 0.5, y: 0.5, exposure: 0 }),
        Escape: () => this.canvas.blur(),
      };
      if (!onRange && e.target === this.canvas) {
        actions.ArrowLeft = () => this.set({ x: s.x - step });
        actions.ArrowRight = () => this.set({ x: s.x + step });
        actions.ArrowUp = () => this.set({ y: s.y - step });
        actions.ArrowDown = () => this.set({ y: s.y + step });
      }
      METHODS.forEach((m, i) => { actions[i + 1] = () => this.set({ method: m }); });
      if (!actions[e.key]) return;
      e.preventDefault();
      actions[e.key]();
    }

    fraction(e) {
      const box = this.canvas.getBoundingClientRect();
      return { x: (e.clientX - box.left) / box.width, y: (e.clientY - box.top) / box.height };
    }

    /** Where a point of the canvas lies in the image; both in fractions. */
    toImage(p) {
      return { x: this.state.x + (p.x - 0.5) / this.state.zoom, y: this.state.y + (p.y - 0.5) / this.state.zoom };
    }

    zoomAt(factor, px, py) {
      const at = this.toImage({ x: px, y: py });
      const zoom = Math.min(48, Math.max(1, this.state.zoom * factor));
      this.set({ zoom, x: at.x - (px - 0.5) / zoom, y: at.y - (py - 0.5) / zoom });
    }

    pointerMoved(e) {
      const p = this.fraction(e);
      const before = this.pointers.get(e.pointerId);
      if (before && this.dragsDivider) {
        this.set({ split: Math.min(1, Math.max(0, p.x)) });
      } else if (before && this.pointers.size === 2) {
        const other = [...this.pointers].find(([id]) => id !== e.pointerId)[1];
        const w = this.canvas.clientWidth, h = this.canvas.clientHeight;
        const length = (a, b) => Math.hypot((a.x - b.x) * w, (a.y - b.y) * h);
        this.zoomAt(length(p, other) / Math.max(1, length(before, other)), (p.x + other.x) / 2, (p.y + other.y) / 2);
        this.set({ x: this.state.x - (p.x - before.x) / 2 / this.state.zoom,
                   y: this.state.y - (p.y - before.y) / 2 / this.state.zoom });
      } else if (before) {
        this.set({ x: this.state.x - (p.x - before.x) / this.state.zoom,
                   y: this.state.y - (p.y - before.y) / this.state.zoom });
      }
      if (before) this.pointers.set(e.pointerId, p);
      this.say(p);
    }

    set(change) {
      // a comparison of a method with itself shows nothing: compare with the one that was shown before
      if (change.method === this.state.against && change.method !== this.state.method)
        this.state.against = this.state.method;
      Object.assign(this.state, change);
      const margin = 0.5 / this.state.zoom;
      this.state.x = Math.min(1 - margin, Math.max(margin, this.state.x));
      this.state.y = Math.min(1 - margin, Math.max(margin, this.state.y));
      if ("method" in change) this.blinkPhase = false;
      this.update();
    }

    /** #NAME:method=mis,budget=time,view=error,zoom=4,x=0.2,y=0.5,exposure=1,split=0.5,against=direct */
    fromHash() {
      for (const part of decodeURIComponent(location.hash.slice(1)).split(";")) {
        const [name, values] = part.split(":");
        if (name !== this.name || !values) continue;
        for (const pair of values.split(",")) {
          const [key, value] = pair.split("=");
          if (!(key in this.state)) continue;
          const known = { method: METHODS, against: METHODS, budget: ["samples", "time"], view: VIEWS }[key];
          if (known && known.includes(value)) this.state[key] = value;
          if (!known && Number.isFinite(Number(value))) this.state[key] = Number(value);
        }
        this.state.blink = Boolean(this.state.blink);
      }
    }

    // --- drawing -------------------------------------------------------------------------------------------------

    source(method) { return method === "reference" ? "reference" : `${method}-${this.state.budget}`; }

    /** The pixels of a source, or undefined while they are being decoded. */
    pixels(source) {
      if (!this.decoded.has(source)) {
        this.decoded.set(source, undefined);
        decode(this.data.images[source], this.data.width, this.data.height).then((pixels) => {
          this.decoded.set(source, pixels);
          this.draw();
        });
      }
      return this.decoded.get(source);
    }

    /** A canvas with the colours of one method in the present view, kept until the view changes. */
    paint(method) {
      const { view, exposure } = this.state;
      const source = this.source(method);
      const pixels = this.pixels(source);
      const reference = view === "difference" ? this.pixels("reference") : null;
      if (!pixels || reference === undefined) return null;
      const end = view === "difference" ? this.differenceEnd() : 0;
      const key = `${view} ${exposure} ${end}`;
      let painted = this.painted.get(source);
      if (painted && painted.key === key) return painted.canvas;
      const { width, height, heat, colors } = this.data;
      if (!painted) {
        painted = { canvas: document.createElement("canvas") };
        painted.canvas.width = width;
        painted.canvas.height = height;
        this.painted.set(source, painted);
      }
      painted.key = key;
      const context = painted.canvas.getContext("2d");
      const out = context.createImageData(width, height);
      const gain = 2 ** exposure;
      const logLow = Math.log(heat[0]);
      const logRange = Math.log(heat[1] / heat[0]);
      for (let i = 0; i < width * height; ++i) {
        if (view === "image") {
          for (let c = 0; c < 3; ++c) out.data[4 * i + c] = srgb(pixels.rgb[3 * i + c] * gain);
        } else if (view === "error") {
          const e = pixels.error[i];
          const t = e > 0 ? Math.min(1, Math.max(0, (Math.log(e) - logLow) / logRange)) : 0;
          const k = 3 * Math.round(t * 255);
          for (let c = 0; c < 3; ++c) out.data[4 * i + c] = colors[k + c];
        } else {
          // difference: red too bright, blue too dark, white equal
          const d = (luminance(pixels.rgb, i) - luminance(reference.rgb, i)) / end;
          const t = Math.min(1, Math.abs(d));
          const low = Math.round(245 * (1 - t));
          out.data[4 * i] = d > 0 ? 245 - 40 * t : low;
          out.data[4 * i + 1] = low + (d > 0 ? 20 : 80) * t;
          out.data[4 * i + 2] = d > 0 ? low + 30 * t : 245 - 50 * t;
        }
        out.data[4 * i + 3] = 255;
      }
      context.putImageData(out, 0, 0);
      return painted.canvas;
    }

    /** The difference at full colour: 99 of 100 pixels of what is shown are within it. */
    differenceEnd() {
      const s = this.state;
      const shown = s.blink || s.split >= 0 ? [s.method, s.against] : [s.method];
      const ends = shown.map((method) => this.usualDifference(this.source(method)));
      return Math.max(...ends) / 2 ** s.exposure;
    }

    /** The 99th percentile of the absolute difference to the reference, rounded up to 1, 2 or 5 times a power of ten; 1
     *  while the pixels are being decoded. */
    usualDifference(source) {
      const pixels = this.pixels(source), reference = this.pixels("reference");
      if (!pixels || !reference || pixels === reference) return pixels === reference ? 1e-6 : 1;
      if (pixels.usualDifference === undefined) {
        const sizes = new Float32Array(pixels.error.length);
        for (let i = 0; i < sizes.length; ++i)
          sizes[i] = Math.abs(luminance(pixels.rgb, i) - luminance(reference.rgb, i));
        sizes.sort();
        const least = Math.max(1e-6, sizes[Math.floor(0.99 * sizes.length)]);
        const decade = 10 ** Math.floor(Math.log10(least));
        pixels.usualDifference = decade * [1, 2, 5, 10].find((step) => step * decade >= least * 0.999999);
      }
      return pixels.usualDifference;
    }

    draw() {
      const c = this.canvas;
      const ratio = window.devicePixelRatio || 1;
      const w = Math.round(c.clientWidth * ratio), h = Math.round(c.clientHeight * ratio);
      if (!w || !h) return;
      if (c.width !== w || c.height !== h) { c.width = w; c.height = h; }
      const s = this.state;
      const shown = s.blink && this.blinkPhase ? s.against : s.method;
      const first = this.paint(shown);
      const second = s.split >= 0 ? this.paint(s.against) : null;
      const context = c.getContext("2d");
      if (!first || (s.split >= 0 && !second)) {
        this.root.classList.add("loading");
        return;
      }
      this.root.classList.remove("loading");
      if (s.view === "difference") {
        const end = number(this.differenceEnd());
        this.$(".difference-low").textContent = `−${end}`;
        this.$(".difference-high").textContent = `+${end}`;
      }
      const { width, height } = this.data;
      context.imageSmoothingEnabled = s.zoom * w < 1.5 * width;
      const place = [(s.x - 0.5 / s.zoom) * width, (s.y - 0.5 / s.zoom) * height, width / s.zoom, height / s.zoom];
      context.clearRect(0, 0, w, h);
      context.drawImage(first, ...place, 0, 0, w, h);
      if (second) {
        const x = Math.round(s.split * w);
        context.save();
        context.beginPath();
        context.rect(x, 0, w - x, h);
        context.clip();
        context.drawImage(second, ...place, 0, 0, w, h);
        context.restore();
        context.fillStyle = "#000";
        context.fillRect(x - 2 * ratio, 0, 4 * ratio, h);
        context.fillStyle = "#fff";
        context.fillRect(x - ratio, 0, 2 * ratio, h);
      }
      this.$(".shown").textContent = s.split >= 0 ? `${s.method} | ${s.against}` : shown;
    }

    update() {
      const s = this.state;
      for (const group of ["method", "budget", "view"])
        for (const button of this.root.querySelectorAll(`[data-${group}]`))
          button.setAttribute("aria-pressed", String(button.dataset[group] === s[group]));
      this.$(".blink").setAttribute("aria-pressed", String(s.blink));
      this.$(".split").setAttribute("aria-pressed", String(s.split >= 0));
      this.$(".divider").hidden = s.split < 0;
      this.$(".divider").value = s.split;
      this.$(".against").value = s.against;
      this.$(".exposure").value = s.exposure;
      this.$(".exposure-value").textContent = `${s.exposure > 0 ? "+" : ""}${s.exposure} stops`;
      this.$(".zoom-value").textContent = `${Math.round(100 * s.zoom) / 100}×`;
      this.$(".scale-error").hidden = s.view !== "error";
      this.$(".scale-difference").hidden = s.view !== "difference";
      this.$(".cost").textContent = this.data.costs[this.source(s.method)];
      this.draw();
      this.say(this.last);
    }

    say(p) {
      this.last = p;
      if (!p || p.x < 0 || p.x >= 1 || p.y < 0 || p.y >= 1) {
        this.readout.textContent = "Point at a pixel to read its value.";
        return;
      }
      const s = this.state;
      const method = s.split >= 0 && p.x > s.split ? s.against : s.blink && this.blinkPhase ? s.against : s.method;
      const pixels = this.pixels(this.source(method));
      if (!pixels) return;
      const at = this.toImage(p);
      const x = Math.min(this.data.width - 1, Math.floor(at.x * this.data.width));
      const y = Math.min(this.data.height - 1, Math.floor(at.y * this.data.height));
      const i = y * this.data.width + x;
      const rgb = [0, 1, 2].map((c) => number(pixels.rgb[3 * i + c])).join(", ");
      this.readout.textContent = `${method} (${x}, ${y}): luminance ${number(luminance(pixels.rgb, i))} ± ` +
        `${number(pixels.error[i])}, RGB ${rgb}`;
    }
  }

  for (const root of document.querySelectorAll(".viewer")) {
    root.hidden = false;
    new Viewer(root);
  }
})();
