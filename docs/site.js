// Each cell of a table knows its column, for the width of a phone where a row is a card; a long path breaks at its parts.
for (const table of document.querySelectorAll("[role=main] table")) {
  const names = [...table.querySelectorAll("thead th")].map((each) => each.textContent);
  for (const row of table.querySelectorAll("tbody tr")) {
    [...row.children].forEach((cell, at) => cell.setAttribute("data-name", names[at] || ""));
  }
  const texts = document.createTreeWalker(table, NodeFilter.SHOW_TEXT), long = [];
  while (texts.nextNode()) if (/\S{16}/.test(texts.currentNode.data)) long.push(texts.currentNode);
  for (const text of long) {
    const parts = text.data.split(/(?<=[/_:.@])(?=\S)/);
    text.replaceWith(...parts.flatMap((part, at) => (at ? [document.createElement("wbr"), part] : [part])));
  }
}
// What scrolls is reached by the keyboard; the bar above is found by a screen reader.
for (const block of document.querySelectorAll("pre, p:has(> img)")) block.tabIndex = 0;
document.querySelector(".navbar").setAttribute("role", "navigation");
