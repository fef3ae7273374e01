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
  const scheme = matchMedia("(prefers-color-scheme: dark)");
  const phone = matchMedia("(max-width: 760px)");
  const config = {
    responsive: true, displaylogo: false, showSendToCloud: false,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "zoomIn2d", "zoomOut2d"],
  };

  // The colours of paper, ink and lines, which the page's style names; data keep theirs.
  function coloured(value) {
    const style = getComputedStyle(document.documentElement);
    const named = { "#222222": "--ink", "#ffffff": "--paper", "white": "--paper", "#e3e6ea": "--line", "#0072b2": "--accent", "#0072B2": "--accent" };
    const swap = (item) => {
      if (typeof item === "string") return item in named ? style.getPropertyValue(named[item]).trim() : item;
      if (Array.isArray(item)) return typeof item[0] === "number" ? item : item.map(swap);
      if (item && typeof item === "object")
        return Object.fromEntries(Object.entries(item).map(([key, each]) => [key, swap(each)]));
      return item;
    };
    return swap(value);
  }

  // On a phone: small margins and letters, the colour bar below the plot.
  function fitted({ data, layout, narrow }) {
    if (!phone.matches) return { data, layout };
    const bar = { orientation: "h", y: -0.16, yanchor: "top", thickness: 10, len: 0.9 };
    const below = (item) => item && item.colorbar
      ? { ...item, colorbar: { ...item.colorbar, ...bar, title: { ...item.colorbar.title, side: "bottom", font: { size: 11 } } } }
      : item;
    const small = structuredClone(layout);
    small.font = { ...small.font, size: 11 };
    small.margin = layout.scene ? { l: 0, r: 0, t: 10, b: 70 } : { l: 48, r: 8, t: 60, b: 44 };
    small.height = Math.min(layout.height, layout.scene ? 420 : 520);
    for (const slider of small.sliders ?? []) {  // below the colour bar
      slider.pad = { t: 120 };
      small.margin.b = 172;
      small.height = 560;
    }
    for (const [key, axis] of Object.entries(small)) if (/^[xy]axis/.test(key) && axis.title) axis.title.font = { size: 11 };
    const parts = data.map((trace) => ({ ...below(trace), ...(trace.marker && { marker: below(trace.marker) }) }));
    return { data: parts, layout: merged(small, narrow ?? {}) };
  }

  function merged(into, from) {
    for (const [key, value] of Object.entries(from))
      into[key] = value && typeof value === "object" && !Array.isArray(value) ? merged(into[key] ?? {}, value) : value;
    return into;
  }

  const shown = [];
  async function draw([plot, figure]) {
    const { data, layout } = coloured(fitted(figure));
    const hoverlabel = { bgcolor: layout.paper_bgcolor, font: { color: layout.font?.color } };
    const bar = { bgcolor: "rgba(0,0,0,0)", color: "#8a8f98", activecolor: "#0072b2" };
    await Plotly.react(plot, data, { hoverlabel, modebar: bar, ...layout }, config);
  }
  for (const script of document.querySelectorAll("script.plot-data")) {
    const place = script.closest("figure");
    const figure = JSON.parse(script.textContent);
    if (figure.layout.scene && !solid) continue;
    const plot = place.querySelector(".plot");
    plot.hidden = false;
    place.classList.add("live");
    shown.push([plot, figure]);
  }
  async function drawAll() {
    document.documentElement.dataset.drawn = "";
    for (const each of shown) await draw(each);
    document.documentElement.dataset.drawn = "all";
  }
  for (const change of [scheme, phone]) change.addEventListener("change", drawAll);
  await drawAll();
})();
