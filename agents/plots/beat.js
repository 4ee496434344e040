// Plays every figure of agents/plots/beat.py on the page: the frames stand in its layout's meta, numbers and all, so
// that nothing is computed here. It finds figures that come or change later, and needs nothing but Plotly.
"use strict";
(() => {
  const STYLE = `
    .beat-button { position: absolute; top: 2px; right: 2px; z-index: 5; min-width: 44px; min-height: 36px;
                   font: inherit; font-size: 16px; background: #fff; color: #1a1a1a; border: 1px solid #8c8c8c;
                   border-radius: 6px; cursor: pointer; }
    .beat-button:focus-visible { outline: 3px solid #0072B2; }
    @media print { .beat-button { display: none; } }`;
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  const states = new WeakMap(); // by figure: whether it plays, the frame shown, when it began

  function addStyle() {
    const sheet = new CSSStyleSheet(); // allowed where the page forbids inline styles
    sheet.replaceSync(STYLE);
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
  }

  function label(state) {
    state.button.textContent = state.playing ? "❚❚" : "▶";
    state.button.setAttribute("aria-label", state.playing ? "pause the wingbeat" : "play the wingbeat");
  }

  function stateOf(figure) {
    let state = states.get(figure);
    if (!state) {
      state = { playing: !still.matches, frame: 0, start: null, busy: false, button: document.createElement("button") };
      state.button.type = "button";
      state.button.className = "beat-button";
      state.button.addEventListener("click", () => {
        state.playing = !state.playing;
        state.start = null;
        label(state);
      });
      label(state);
      states.set(figure, state);
    }
    if (!figure.contains(state.button)) {
      figure.style.position = "relative";
      figure.appendChild(state.button);
      figure.dataset.frame = String(state.frame);
    }
    return state;
  }

  function show(figure, state, number, beat) {
    const frame = beat.frames[number];
    const data = beat.traces.map((_, i) => {
      const piece = { x: frame.x[i], y: frame.y[i] };
      if (frame.text[i]) piece.text = frame.text[i];
      return piece;
    });
    const at = { frame: { duration: 0, redraw: false }, transition: { duration: 0 }, mode: "immediate" };
    state.busy = true;
    state.frame = number;
    figure.dataset.frame = String(number);
    Plotly.animate(figure, { data, traces: beat.traces }, at)
      .catch(() => {}) // a newer drawing of the same figure took over
      .then(() => { state.busy = false; });
  }

  function visible(figure) {
    const box = figure.getBoundingClientRect();
    return box.bottom > 0 && box.top < window.innerHeight && box.width > 0;
  }

  function tick(now) {
    for (const figure of document.querySelectorAll(".js-plotly-plot")) {
      const beat = figure.layout && figure.layout.meta && figure.layout.meta.beat;
      if (!beat || !figure._fullLayout) continue;
      const state = stateOf(figure);
      if (!state.playing || state.busy || !visible(figure)) continue;
      const count = beat.frames.length, each = (1000 * beat.seconds) / count;
      if (state.start === null) state.start = now - state.frame * each;
      const number = Math.floor((now - state.start) / each) % count;
      if (number !== state.frame) show(figure, state, number, beat);
    }
    window.requestAnimationFrame(tick);
  }

  addStyle();
  window.requestAnimationFrame(tick);
})();
