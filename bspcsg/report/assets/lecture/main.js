// The figures of the page; each is one function of its element.
const FIGURES = {
  "fig-hyperplane": hyperplaneFigure,
  "fig-search": searchFigure,
  "fig-autopartition": autopartitionFigure,
  "fig-shield": shieldFigure,
  "fig-painter": painterFigure,
  "fig-ray": rayFigure,
  "fig-policies": policiesFigure,
  "fig-adaptive": adaptiveFigure,
  "fig-intervals": intervalsFigure,
  "fig-split": splitFigure,
  "fig-merge": mergeFigure,
  "fig-space": spaceFigure,
  "fig-solids": solidsFigure,
};

function say(figure, sentence) {
  figure.append(element("p", { class: "say", role: "status" }, sentence));
}

/** Mark the chapter that is being read. */
function followChapters() {
  const links = new Map([...document.querySelectorAll("nav a")].map((link) => [link.hash.slice(1), link]));
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      links.forEach((link, id) => {
        if (id === entry.target.id) link.setAttribute("aria-current", "true");
        else link.removeAttribute("aria-current");
      });
      const bar = document.querySelector("nav ol");
      const link = links.get(entry.target.id);
      bar.scrollTo({ left: link.offsetLeft - bar.clientWidth / 2 + link.offsetWidth / 2 });
    }
  }, { rootMargin: "-20% 0px -70% 0px" });
  document.querySelectorAll("main > section").forEach((section) => watch.observe(section));
}

/** Let the keyboard scroll formulas and tables that are wider than their place. */
function scrollByKeyboard() {
  for (const wide of document.querySelectorAll("math[display=block], .table-scroll")) {
    if (wide.scrollWidth > wide.clientWidth) wide.setAttribute("tabindex", "0");
    else wide.removeAttribute("tabindex");
  }
}

async function start() {
  followChapters();
  scrollByKeyboard();
  window.addEventListener("resize", scrollByKeyboard);
  const figures = Object.entries(FIGURES).map(([id, make]) => [document.getElementById(id), make]);
  try {
    await startCore();
  } catch (error) {
    figures.forEach(([figure]) => say(figure, `This browser cannot run WebAssembly, so the figure stays empty: ${error.message}`));
    return;
  }
  for (const [figure, make] of figures) {
    try {
      make(figure);
    } catch (error) {
      console.error(error.stack);
      say(figure, `This figure failed: ${error.message}`);
    }
  }
  scrollByKeyboard();
  document.documentElement.dataset.ready = "yes";
}

start();
