// Sorts and filters the table of cases, and shows the cards of what is left.
"use strict";

(() => {
  const table = document.getElementById("cases");
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  const chips = [...document.querySelectorAll("button[data-verdict]")];
  const words = document.getElementById("words");
  const operation = document.getElementById("operation");
  const count = document.getElementById("count");
  const column = (name) => heads.findIndex((head) => head.dataset.column === name);
  const [verdicts, operations] = [column("verdict"), column("operation")];
  const text = (row, index) => row.cells[index].textContent;
  const sought = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));

  const numberOf = (shown) => Number.parseFloat(shown.replace(/\s/g, ""));

  function keyOf(row, index) {
    if (index === verdicts) return Number(row.dataset.rank);
    const shown = text(row, index);
    return heads[index].dataset.kind === "number" ? numberOf(shown) : shown;
  }

  // Cells without a number come last, whichever way the others go.
  function compared(a, b, way) {
    if (typeof a === "string") return way * a.localeCompare(b, "en", { numeric: true });
    if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
    return way * (a - b);
  }

  function sort(index) {
    const falling = heads[index].getAttribute("aria-sort") === "ascending";
    heads.forEach((head) => head.setAttribute("aria-sort", "none"));
    heads[index].setAttribute("aria-sort", falling ? "descending" : "ascending");
    const keyed = rows.map((row) => [keyOf(row, index), row]);
    keyed.sort(([a], [b]) => compared(a, b, falling ? -1 : 1));
    body.append(...keyed.map(([, row]) => row));
  }

  function filter() {
    const asked = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = chips.filter((chip) => chip.getAttribute("aria-pressed") === "true")
      .map((chip) => chip.dataset.verdict);
    let left = 0;
    for (const row of rows) {
      const hit = (!wanted.length || wanted.includes(text(row, verdicts)))
        && (!operation?.value || text(row, operations) === operation.value)
        && asked.every((word) => sought.get(row).includes(word));
      row.hidden = !hit;
      left += hit;
      const card = row.dataset.card && document.getElementById(row.dataset.card);
      if (card) card.hidden = !hit;
    }
    count.textContent = `${left} of ${rows.length} ${table.dataset.of}`;
  }

  heads.forEach((head, index) => {
    head.querySelector("button").addEventListener("click", () => sort(index));
  });
  for (const chip of chips) {
    chip.addEventListener("click", () => {
      chip.setAttribute("aria-pressed", chip.getAttribute("aria-pressed") !== "true");
      filter();
    });
  }
  words.addEventListener("input", filter);
  operation?.addEventListener("change", filter);
  document.getElementById("filters").addEventListener("reset", () => {
    chips.forEach((chip) => chip.setAttribute("aria-pressed", "false"));
    setTimeout(filter);
  });
  document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
  filter();
})();
