// Draws each figure when it is first looked at, and all of them for the printer. The figures stand beside their places.
"use strict";
(() => {
  const PRINTED = 680, PRINTED_PAIR = 635; // px, widths on an A4 page within its margins, alone, and of a pair before its zoom
  const config = JSON.parse(document.getElementById("plot-config").textContent);
  const places = [...document.querySelectorAll(".plot")];

  function draw(place) {
    if (place.dataset.drawn) return;
    place.dataset.drawn = "yes";
    const figure = JSON.parse(document.getElementById(`${place.id}-data`).textContent);
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
      draw(place); // as wide as it will be again: a figure born with a width cannot lose it
      Plotly.relayout(place, { width: place.closest(".pair") ? PRINTED_PAIR : PRINTED });
    }
  });
  window.addEventListener("afterprint", () => {
    places.forEach((place) => Plotly.relayout(place, { width: null, autosize: true }));
    opened.forEach((details) => { details.open = false; });
  });

  for (const details of document.querySelectorAll("details")) { // what is folded away misses a turn of the phone
    details.addEventListener("toggle", () => {
      if (!details.open) return;
      details.querySelectorAll(".plot[data-drawn]").forEach((place) => Plotly.Plots.resize(place));
    });
  }
})();
