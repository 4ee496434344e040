// Lets the figures follow the sliders at the pace they can be drawn in, so that the numbers never wait for them, and
// gives the controls their names.
"use strict";
(() => {
  const QUIET = 60, LONGEST = 300; // milliseconds without a move, and at most between two drawings
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
  window.dash_clientside.explorer = {
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
})();
