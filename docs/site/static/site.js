// Says to screen readers and keyboards what the theme leaves unsaid.
"use strict";

/** Let the keyboard scroll what is wider than its place. */
function scrollByKeyboard() {
  for (const box of document.querySelectorAll("pre, .table-wrapper")) {
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  }
}

/** The lines of a signature, which are no terms with meanings, although they are written so. */
function linesOf(list) {
  const lines = document.createElement("div");
  lines.className = "sig-lines";
  for (const one of list.children) {
    const line = document.createElement("div");
    line.append(...one.childNodes);
    lines.append(line);
  }
  return lines;
}

document.addEventListener("DOMContentLoaded", () => {
  document.querySelector(".sidebar-drawer")?.setAttribute("aria-label", "Pages");
  document.querySelector(".toc-drawer")?.setAttribute("aria-label", "On this page");
  for (const caption of document.querySelectorAll(".caption[role=heading]")) {
    caption.setAttribute("aria-level", "2");
  }
  for (const head of document.querySelectorAll("th")) {
    if (!head.textContent.trim()) head.setAttribute("role", "presentation");
  }
  for (const list of document.querySelectorAll("dt.sig > dl")) list.replaceWith(linesOf(list));
  scrollByKeyboard();
  window.addEventListener("resize", scrollByKeyboard);
  document.addEventListener("click", () => setTimeout(scrollByKeyboard));
});
