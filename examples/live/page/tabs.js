// SPDX-License-Identifier: MIT
// Tabs for mouse and keyboard, following the ARIA Authoring Practices.

// Scrolls so that a new panel starts below the sticky tab list.
function showStartOf(panel, tabList) {
  const hidden = tabList.getBoundingClientRect().bottom - panel.getBoundingClientRect().top;
  if (hidden > 1) scrollBy(0, -hidden);
}

/**
 * @param onChange  Called with the name of the open tab, as in id="tab-NAME".
 * @returns a function that opens a tab by its name.
 */
export function setUpTabs(onChange) {
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const open = (tab) => {
    for (const each of tabs) {
      const isOpen = each === tab;
      each.setAttribute("aria-selected", isOpen);
      each.tabIndex = isOpen ? 0 : -1;
      document.getElementById(each.getAttribute("aria-controls")).hidden = !isOpen;
    }
    onChange(tab.id.replace("tab-", ""));
    showStartOf(document.getElementById(tab.getAttribute("aria-controls")), tab.parentElement);
  };
  tabs.forEach((tab, i) => {
    tab.onclick = () => open(tab);
    tab.onkeydown = ({ key }) => {
      const to = { ArrowRight: i + 1, ArrowLeft: i - 1, Home: 0, End: tabs.length - 1 }[key];
      if (to === undefined) return;
      const next = tabs[(to + tabs.length) % tabs.length];
      next.focus();
      open(next);
    };
  });
  return (name) => open(document.getElementById(`tab-${name}`));
}
