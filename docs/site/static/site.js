// Says to screen readers and keyboards what the theme leaves unsaid.
"use strict";

/** Let the keyboard scroll what is wider than its place. */
function scrollByKeyboard() {
  for (const box of document.querySelectorAll("pre, .table-wrapper")) {
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  }
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
  // Signatures with a line for each parameter are no lists of terms with their meanings.
  for (const part of document.querySelectorAll("dt dl, dt dl > dd")) {
    part.setAttribute("role", "presentation");
  }
  scrollByKeyboard();
  window.addEventListener("resize", scrollByKeyboard);
  document.addEventListener("click", () => setTimeout(scrollByKeyboard));
});
