"use strict";
// Tables sort by a click on a column's head; numbers by what they are, texts by their letters.
const compareTexts = new Intl.Collator(undefined, { numeric: true }).compare;
function key(row, column) {
  const cell = row.cells[column];
  const value = cell.dataset.v;
  return value === undefined ? cell.textContent.trim() : Number(value);
}
function sort(table, heading) {
  const column = heading.cellIndex;
  const down = heading.getAttribute("aria-sort") === "ascending";
  for (const other of heading.parentNode.cells) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", down ? "descending" : "ascending");
  const body = table.tBodies[0];
  const rows = Array.from(body.rows, row => [key(row, column), row]);
  rows.sort(([a], [b]) => (typeof a === "number" && typeof b === "number" ? a - b : compareTexts(String(a), String(b))));
  if (down) rows.reverse();
  body.append(...rows.map(([, row]) => row));
}
for (const table of document.querySelectorAll("table.sortable")) {
  table.classList.add("live");
  for (const heading of table.tHead.rows[0].cells) {
    heading.tabIndex = 0;
    heading.addEventListener("click", () => sort(table, heading));
    heading.addEventListener("keydown", event => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); sort(table, heading); } });
  }
}

// Pointing at a mesh, in a figure, a table or the legend, brings it out in all figures; a click keeps it.
const main = document.querySelector("main");
const marks = new Map();
for (const mark of document.querySelectorAll("[data-mesh]")) {
  const mesh = mark.dataset.mesh;
  if (!marks.has(mesh)) marks.set(mesh, []);
  marks.get(mesh).push(mark);
}
let kept = null;
let shown = null;
function show(mesh) {
  if (mesh === shown) return;
  for (const mark of marks.get(shown) || []) mark.classList.remove("on");
  for (const mark of marks.get(mesh) || []) mark.classList.add("on");
  main.classList.toggle("picking", mesh !== null);
  shown = mesh;
}
const meshAt = event => { const mark = event.target.closest("[data-mesh]"); return mark ? mark.dataset.mesh : null; };
main.addEventListener("pointerover", event => show(meshAt(event) ?? kept));
main.addEventListener("pointerleave", () => show(kept));
main.addEventListener("click", event => {
  const mesh = meshAt(event);
  if (mesh !== null) { kept = mesh === kept ? null : mesh; show(kept); }
});

// Rows of meshes by part of their name.
const filter = document.getElementById("filter");
filter.parentNode.hidden = false;
filter.addEventListener("input", () => {
  const part = filter.value.trim().toLowerCase();
  for (const row of document.querySelectorAll("tr[data-mesh]")) {
    row.hidden = !row.cells[0].textContent.toLowerCase().includes(part);
  }
});

// Light, dark, or as the system says; remembered where the browser allows it.
const themes = ["system", "light", "dark"];
const button = document.getElementById("theme");
function setTheme(theme) {
  if (theme === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  button.querySelector("span").textContent = theme;
}
let theme = "system";
try { theme = localStorage.getItem("meshgauge-theme") || theme; } catch { /* storage is off */ }
setTheme(themes.includes(theme) ? theme : "system");
button.hidden = false;
button.addEventListener("click", () => {
  const now = document.documentElement.dataset.theme || "system";
  const next = themes[(themes.indexOf(now) + 1) % themes.length];
  setTheme(next);
  try { localStorage.setItem("meshgauge-theme", next); } catch { /* storage is off */ }
});

// On paper nothing is folded away.
addEventListener("beforeprint", () => { for (const folded of document.querySelectorAll("details:not([open])")) { folded.open = true; folded.dataset.printed = ""; } });
addEventListener("afterprint", () => { for (const folded of document.querySelectorAll("details[data-printed]")) { folded.open = false; delete folded.dataset.printed; } });
