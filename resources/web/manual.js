// `sections` and `nothing` stand before this: what is searched, and what is said where nothing is found.
const field = document.getElementById("search"), found = document.getElementById("found");
function score(section, words) {
  const title = (section[1] + " " + section[2]).toLowerCase(), text = section[3].toLowerCase();
  let sum = 0;
  for (const word of words) {
    if (!title.includes(word) && !text.includes(word)) return 0;
    sum += (title.includes(word) ? 10 : 0) + Math.min(text.split(word).length - 1, 5) + 1;
  }
  return sum;
}
function excerpt(text, word) {
  const at = Math.max(0, text.toLowerCase().indexOf(word));
  const begin = Math.max(0, at - 40), end = Math.min(text.length, at + 100);
  return (begin ? "… " : "") + text.slice(begin, end) + (end < text.length ? " …" : "");
}
function show() {
  const words = field.value.toLowerCase().split(/\s+/).filter(word => word);
  found.hidden = !words.length;
  const hits = words.length ? sections.map(each => [score(each, words), each]).filter(each => each[0]) : [];
  hits.sort((a, b) => b[0] - a[0]);
  found.replaceChildren(...hits.slice(0, 20).map(([, section]) => {
    const item = document.createElement("li"), link = document.createElement("a"), text = document.createElement("p");
    link.href = section[0];
    link.textContent = section[1] === section[2] ? section[1] : section[1] + ": " + section[2];
    text.textContent = excerpt(section[3], words[0]);
    item.append(link, text);
    return item;
  }));
  if (words.length && !hits.length) found.textContent = nothing;
}
field.addEventListener("input", show);
field.form.addEventListener("submit", event => {
  event.preventDefault();
  const first = found.querySelector("a");
  if (first) location.href = first.href;
});
document.addEventListener("keydown", event => {
  if (event.key === "/" && document.activeElement !== field) { event.preventDefault(); field.focus(); }
  if (event.key === "Escape") { field.value = ""; show(); }
});
document.addEventListener("click", event => { if (found.contains(event.target)) { field.value = ""; show(); } });
