"use strict";
document.body.classList.remove("no-script");

// Tables: a click on a heading sorts, a second one turns the order around. NaN stays last either way.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const headings = [...table.tHead.rows[0].cells];
  headings.forEach((heading, column) => heading.querySelector("button").addEventListener("click", () => {
    const descending = heading.getAttribute("aria-sort") === "ascending";
    headings.forEach((other) => other.removeAttribute("aria-sort"));
    heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
    const numeric = heading.classList.contains("n");
    const sign = descending ? -1 : 1;
    const key = (row) => numeric ? Number(row.cells[column].dataset.v) : row.cells[column].textContent;
    const compare = (a, b) => {
      if (!numeric) return sign * a.localeCompare(b, undefined, { numeric: true });
      if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
      return sign * (a - b);
    };
    body.append(...[...body.rows].map((row) => [key(row), row]).sort((a, b) => compare(a[0], b[0])).map(([, row]) => row));
  }));
}

// The filter of a table keeps rows that hold every word.
for (const filter of document.querySelectorAll(".filter input")) {
  const rows = filter.closest(".scene").querySelectorAll("table.sortable tbody tr");
  filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of rows) row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
  });
}

// The choice of map size hides the other cards; the truth always stays.
for (const gallery of document.querySelectorAll("[data-gallery]")) {
  const sizes = gallery.querySelectorAll('input[name^="size-"]');
  const show = (size) => {
    for (const card of gallery.querySelectorAll(".card")) card.hidden = size !== "" && card.dataset.size !== "" && card.dataset.size !== size;
  };
  sizes.forEach((input) => input.addEventListener("change", () => show(input.value)));
  // Start with the size in the middle: one picture per technique is what an eye can compare.
  const middle = sizes[Math.floor((sizes.length - 1) / 2)];
  if (middle) { middle.checked = true; show(middle.value); }
}

// Paper cannot scroll: pictures that were not looked at yet must be there.
window.addEventListener("beforeprint", () => document.querySelectorAll("img[loading]").forEach((image) => { image.loading = "eager"; }));

// Full size: one picture at a time; flipping between shadows, truth, error and texels keeps place and zoom.
const box = document.getElementById("lightbox");
const stage = box.querySelector(".lb-stage");
const picture = stage.querySelector("img");
const LAYERS = ["mask", "truth", "heat", "footprint"];
const ZOOMS = [0, 1, 2, 4];
const state = { cards: [], at: 0, layer: "mask", zoom: 0 };

const source = (card, layer) => layer === "truth"
  ? card.closest("[data-gallery]").querySelector(".truth img")
  : card.querySelector(`img.${layer}`);

function render() {
  const card = state.cards[state.at];
  const present = LAYERS.filter((layer) => source(card, layer));
  const layer = present.includes(state.layer) ? state.layer : present[0];
  const shown = layer && source(card, layer);
  picture.hidden = !shown;
  if (shown) { picture.src = shown.src; picture.alt = shown.alt; }
  box.querySelector(".lb-name b").textContent = card.dataset.name;
  box.querySelector(".lb-name span").textContent = [card.dataset.size, card.querySelector(".time")?.textContent, card.querySelector(".figures").textContent].filter(Boolean).join(" · ");
  box.querySelector(".lb-count").textContent = `${state.at + 1} / ${state.cards.length}`;
  for (const button of box.querySelectorAll("[data-layer]")) {
    button.disabled = !present.includes(button.dataset.layer);
    button.setAttribute("aria-pressed", button.dataset.layer === layer);
  }
  for (const button of box.querySelectorAll("[data-zoom]")) button.setAttribute("aria-pressed", Number(button.dataset.zoom) === state.zoom);
  stage.toggleAttribute("data-fit", state.zoom === 0);
  const width = shown && (Number(shown.getAttribute("width")) || shown.naturalWidth);
  picture.style.width = state.zoom && width ? `${width * state.zoom}px` : "";
}

// Zooming keeps the middle of the view, or the point that was clicked, where it is.
function zoom(next, point) {
  const before = picture.getBoundingClientRect();
  const view = stage.getBoundingClientRect();
  const focus = point || { x: view.left + view.width / 2, y: view.top + view.height / 2 };
  // A fitted picture may have empty bands around it: measure what is drawn of it.
  const fit = state.zoom === 0 && picture.naturalWidth
    ? Math.min(before.width / picture.naturalWidth, before.height / picture.naturalHeight) : 0;
  const drawn = fit ? { w: picture.naturalWidth * fit, h: picture.naturalHeight * fit } : { w: before.width, h: before.height };
  const u = (focus.x - before.left - (before.width - drawn.w) / 2) / drawn.w;
  const v = (focus.y - before.top - (before.height - drawn.h) / 2) / drawn.h;
  state.zoom = next;
  render();
  const after = picture.getBoundingClientRect();
  stage.scrollLeft += after.left + u * after.width - focus.x;
  stage.scrollTop += after.top + v * after.height - focus.y;
}

function move(step) {
  state.at = (state.at + step + state.cards.length) % state.cards.length;
  render();
}

function flip() {
  const present = LAYERS.filter((layer) => source(state.cards[state.at], layer));
  state.layer = present[(present.indexOf(state.layer) + 1) % present.length] ?? state.layer;
  render();
}

document.addEventListener("click", (event) => {
  const open = event.target.closest(".open");
  if (!open) return;
  const card = open.closest(".card");
  state.cards = [...card.closest("[data-gallery]").querySelectorAll(".card:not([hidden])")];
  state.at = state.cards.indexOf(card);
  state.layer = event.target.closest("img")?.className || (card.classList.contains("truth") ? "truth" : "mask");
  state.zoom = 0;
  box.showModal();
  stage.focus();
  render();
});

box.addEventListener("click", (event) => {
  const button = event.target.closest("button");
  if (!button) return;
  if ("close" in button.dataset) box.close();
  else if (button.dataset.layer) { state.layer = button.dataset.layer; render(); }
  else if (button.dataset.zoom) zoom(Number(button.dataset.zoom));
  else if (button.dataset.move) move(Number(button.dataset.move));
});

box.addEventListener("close", () => {
  state.cards[state.at]?.querySelector(".open").focus();
  picture.removeAttribute("src");
});

box.addEventListener("keydown", (event) => {
  if (event.altKey || event.ctrlKey || event.metaKey) return;
  const onButton = event.target.closest("button");
  const act = {
    ArrowLeft: () => move(-1),
    ArrowRight: () => move(1),
    1: () => { state.layer = "mask"; render(); },
    2: () => { state.layer = "truth"; render(); },
    3: () => { state.layer = "heat"; render(); },
    4: () => { state.layer = "footprint"; render(); },
    z: () => zoom(ZOOMS[(ZOOMS.indexOf(state.zoom) + 1) % ZOOMS.length]),
    " ": onButton ? undefined : flip,
  }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (act) { event.preventDefault(); act(); }
});

// A click on a fitted picture zooms in there; dragging a zoomed one moves it.
let drag = null;
stage.addEventListener("pointerdown", (event) => {
  if (event.button !== 0 || state.zoom === 0) return;
  drag = { x: event.clientX, y: event.clientY, left: stage.scrollLeft, top: stage.scrollTop };
  stage.setPointerCapture(event.pointerId);
});
stage.addEventListener("pointermove", (event) => {
  if (!drag) return;
  stage.scrollLeft = drag.left - (event.clientX - drag.x);
  stage.scrollTop = drag.top - (event.clientY - drag.y);
});
for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => { drag = null; });
stage.addEventListener("click", (event) => { if (state.zoom === 0) zoom(2, { x: event.clientX, y: event.clientY }); });
