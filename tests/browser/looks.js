// What a reader would complain about on the page that is shown: one line each.
() => {
  const found = [];
  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth) found.push(`the page is ${root.scrollWidth} px wide, the screen ${root.clientWidth}`);
  const box = (element) => element.getBoundingClientRect();
  for (const figure of document.querySelectorAll("figure")) {
    const drawn = [...figure.querySelectorAll("svg, canvas")].filter((e) => box(e).width > 100 && box(e).height > 60);
    if (!drawn.length) found.push(`figure ${figure.id} is not there`);
    if (drawn.some((e) => box(e).right > root.clientWidth + 1)) found.push(`figure ${figure.id} is cropped`);
    const named = [...figure.querySelectorAll("[role=img]")].filter((e) => box(e).width > 0);
    if (!named.some((e) => (e.getAttribute("aria-label") ?? "").length > 20)) found.push(`figure ${figure.id} has no alternative text`);
    for (const text of figure.querySelectorAll("svg text")) {
      const shown = box(text);
      const colour = getComputedStyle(text).fill;
      if (!shown.width || !text.textContent.trim() || colour === "none" || getComputedStyle(text).fillOpacity === "0") continue;
      const scale = Math.hypot(text.getScreenCTM().a, text.getScreenCTM().b);
      const size = parseFloat(getComputedStyle(text).fontSize) * scale;
      if (size < 9) found.push(`figure ${figure.id}: "${text.textContent.trim()}" is ${size.toFixed(1)} px high`);
    }
  }
  return found;
}
