"use strict";
// A filter of the cases by words and tags, links that open what they lead to, and cases folded on phones. Without it everything can be read all the
// same. Neither angle brackets nor ampersands: the page stays well-formed XML.
(function () {
  const field = document.getElementById("filter");
  const cases = Array.from(document.querySelectorAll("details.case"));
  function show() {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const item of cases) {
      const text = (item.dataset.tags + " " + item.textContent).toLowerCase();
      item.hidden = words.some(function (word) { return !text.includes(word); });
      shown += item.hidden ? 0 : 1;
    }
    document.getElementById("shown").textContent = words.length ? shown + " of " + cases.length : "";
  }
  function open() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let item = target; item; item = item.parentElement) {
      if (item.tagName === "DETAILS") {
        item.hidden = false;
        item.open = true;
      }
    }
    target?.scrollIntoView();
  }
  if (matchMedia("screen and (max-width: 44rem)").matches) {
    document.querySelectorAll("details.fold").forEach(function (item) { item.open = false; });
  }
  field.closest("p").hidden = false;
  field.addEventListener("input", show);
  addEventListener("hashchange", open);
  open();
})();
