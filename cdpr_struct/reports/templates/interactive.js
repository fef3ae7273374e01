// Replaces static figures by interactive ones. Where anything is missing the static figure stays.
(async () => {
  const packed = document.getElementById("plotly-packed");
  if (!packed || typeof DecompressionStream === "undefined") return;
  const bytes = Uint8Array.from(atob(packed.textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const source = document.createElement("script");
  source.textContent = await new Response(stream).text();
  document.head.append(source);
  packed.remove();
  const solid = Boolean(document.createElement("canvas").getContext("webgl"));
  for (const script of document.querySelectorAll("script.plot-data")) {
    const figure = script.closest("figure");
    const { data, layout } = JSON.parse(script.textContent);
    if (layout.scene && !solid) continue;
    const plot = figure.querySelector(".plot");
    plot.hidden = false;
    figure.classList.add("live");
    await Plotly.newPlot(plot, data, layout, {
      responsive: true, displaylogo: false, showSendToCloud: false,
      modeBarButtonsToRemove: ["select2d", "lasso2d", "zoomIn2d", "zoomOut2d"],
    });
  }
})();
