// Draws each figure when it is first looked at, and all of them for the printer. The figures stand beside their places.
"use strict";
(() => {
  const PRINTED = 680, PRINTED_PAIR = 460; // px, widths on an A4 page within its margins, alone and side by side
  const config = JSON.parse(document.getElementById("plot-config").textContent);
  const places = [...document.querySelectorAll(".plot")];

  function draw(place, width) {
    if (place.dataset.drawn) return;
    place.dataset.drawn = "yes";
    const figure = JSON.parse(document.getElementById(`${place.id}-data`).textContent);
    if (width) figure.layout.width = width;
    Plotly.newPlot(place, figure.data, figure.layout, config);
  }

  const watcher = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        watcher.unobserve(entry.target);
        draw(entry.target);
      }
    },
    { rootMargin: "300px" }
  );
  places.forEach((place) => watcher.observe(place));

  let opened = [];
  window.addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open])")];
    opened.forEach((details) => { details.open = true; });
    for (const place of places) {
      const width = place.closest(".pair") ? PRINTED_PAIR : PRINTED;
      if (place.dataset.drawn) Plotly.relayout(place, { width });
      else draw(place, width);
    }
  });
  window.addEventListener("afterprint", () => {
    opened.forEach((details) => { details.open = false; });
    places.forEach((place) => Plotly.relayout(place, { width: null, autosize: true }));
  });
})();
