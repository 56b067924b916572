// SPDX-License-Identifier: MIT
// The guide's panel: its steps, and a problem with the button that solves it.

const at = (id) => document.getElementById(id);

// On a phone, the sticky video covers content that is scrolled below it.
function showStart(guide) {
  guide.scrollTop = 0;
  const covered = at("frame").getBoundingClientRect().bottom - guide.getBoundingClientRect().top;
  if (covered > 1) scrollBy(0, -covered);
}

/** Shows a step from its beginning: "see", "mark" or "result". */
export function showStep(step) {
  hideTrouble();
  at("guide-skip").textContent = step === "result" ? "Close" : "Skip";
  let isDone = true;
  for (const item of at("guide-steps").children) {
    const isCurrent = item.dataset.step === step;
    isDone &&= !isCurrent;
    item.classList.toggle("done", isDone);
    if (isCurrent) item.setAttribute("aria-current", "step");
    else item.removeAttribute("aria-current");
  }
  const guide = at("guide");
  const hadFocus = guide.contains(document.activeElement);
  for (const part of guide.querySelectorAll("[data-part]")) part.hidden = part.dataset.part !== step;
  if (hadFocus) guide.focus({ preventScroll: true });
  showStart(guide);
}

/** Shows a problem and a button that solves it. */
export function showTrouble(text, solution, solve) {
  at("guide-trouble").firstElementChild.textContent = text;
  at("guide-again").textContent = solution;
  at("guide-again").onclick = solve;
  at("guide-trouble").hidden = false;
}

export function hideTrouble() {
  at("guide-trouble").hidden = true;
}
