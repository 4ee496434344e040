// Lets the figures follow the sliders at the pace they can be drawn in, so that the numbers never wait for them.
"use strict";
(() => {
  const QUIET = 120, LONGEST = 600; // milliseconds without a move, and at most between two drawings
  let timer = null, since = null;
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
