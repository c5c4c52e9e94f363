// Loads a page again when the server that it is from has a newer one.
"use strict";

(() => {
  const WAIT = 1000;
  let seen = null;

  async function ask() {
    try {
      const answer = await fetch("/changes", { cache: "no-store" });
      const now = await answer.text();
      if (seen !== null && now !== seen) location.reload();
      seen = now;
    } catch {
      // The server has ended; whoever starts it again finds this page still asking.
    }
    setTimeout(ask, document.hidden ? 3 * WAIT : WAIT / 2);
  }
  ask();
})();
