/* Finds pages, headings and names of the reference: `pages` of index.js is [title, where, address, words]. */
(function () {
  "use strict";
  var box = document.getElementById("search"), found = document.getElementById("found"), now = -1;
  var root = document.currentScript.getAttribute("data-root");
  function score(page, words) {
    var title = page[0].toLowerCase(), text = page[3].toLowerCase(), sum = 0;
    for (var i = 0; i < words.length; i++) {
      var at = title.indexOf(words[i]);
      if (title === words[i]) sum += 20;
      else if (at === 0) sum += 10;
      else if (at > 0) sum += 6;
      else if (text.indexOf(words[i]) >= 0) sum += 2;
      else return 0;
    }
    return sum - title.length / 100;
  }
  function show() {
    var words = box.value.toLowerCase().split(/\s+/).filter(Boolean), hits = [];
    now = -1;
    found.textContent = "";
    if (!words.length) return;
    pages.forEach(function (page) {
      var s = score(page, words);
      if (s > 0) hits.push([s, page]);
    });
    hits.sort(function (a, b) { return b[0] - a[0]; });
    hits.slice(0, 12).forEach(function (hit) {
      var a = document.createElement("a"), small = document.createElement("small");
      a.href = root + hit[1][2];
      a.textContent = hit[1][0];
      small.textContent = hit[1][1];
      a.appendChild(small);
      found.appendChild(a);
    });
    if (!hits.length) found.innerHTML = "<a>nothing found</a>";
  }
  box.addEventListener("input", show);
  box.addEventListener("keydown", function (event) {
    var links = found.querySelectorAll("a");
    if (event.key === "Escape") { box.value = ""; show(); }
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      now = (now + (event.key === "ArrowDown" ? 1 : links.length - 1)) % Math.max(links.length, 1);
      links.forEach(function (a, i) { a.className = i === now ? "now" : ""; });
      event.preventDefault();
    }
    if (event.key === "Enter" && links.length) location.href = links[Math.max(now, 0)].href;
  });
  if (location.hash.indexOf("#search=") === 0) { box.value = decodeURIComponent(location.hash.slice(8)); show(); }
})();
