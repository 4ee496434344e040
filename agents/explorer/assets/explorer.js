// Keeps each slider and its field alike, lets the figures follow the sliders at the pace they can be drawn in, so that
// the numbers never wait for them, makes the figures as wide as the paper, and gives the controls their names.
"use strict";
(() => {
  const QUIET = 60, LONGEST = 300; // milliseconds without a move, and at most between two drawings
  const PRINTED = 680; // px, width of an A4 page within its margins
  const written = {}; // by slider: what its field was last made to show
  let timer = null, since = null;
  function nameControls() { // for those who hear the page: Dash's sliders and its list know no labels
    const rows = [...document.querySelectorAll(".slider")];
    for (const row of rows)
      for (const part of row.querySelectorAll("[role=slider], input"))
        part.setAttribute("aria-label", row.querySelector(".label").textContent);
    const list = document.getElementById("insect");
    if (list) list.setAttribute("aria-label", "insect");
    const done = rows.length && rows.every((row) => row.querySelector("[role=slider]") && row.querySelector("input"));
    if (done) waiting.disconnect();
  }
  const waiting = new MutationObserver(nameControls);
  waiting.observe(document.documentElement, { childList: true, subtree: true });
  window.dash_clientside = window.dash_clientside || {};
  const set = (id, value) => window.dash_clientside.set_props(id, { value });
  window.dash_clientside.explorer = {
    show(value, id) { // the slider has moved
      written[id] = value;
      return value;
    },
    type(typed, id, used, low, high) { // a number beyond the slider's ends becomes the end, none leaves what was used
      if (typed === written[id]) return;
      written[id] = Number.isFinite(typed) ? Math.min(Math.max(typed, low), high) : used;
      set(`${id}-field`, written[id]);
      if (written[id] !== used) set(id, written[id]);
    },
    calm(...values) {
      const now = performance.now();
      if (since === null) since = now;
      window.clearTimeout(timer);
      timer = window.setTimeout(() => {
        since = null;
        window.dash_clientside.set_props("calm", { data: values });
      }, Math.max(0, Math.min(QUIET, since + LONGEST - now)));
      return window.dash_clientside.no_update;
    },
  };
  const figures = () => document.querySelectorAll(".js-plotly-plot");
  window.addEventListener("beforeprint", () => {
    figures().forEach((figure) => Plotly.relayout(figure, { width: PRINTED }));
  });
  window.addEventListener("afterprint", () => {
    figures().forEach((figure) => Plotly.relayout(figure, { width: null, autosize: true }));
  });
})();
