'use strict';
(() => {
  // One entry for each page: its address, its title, its headings, and its words.
  const pages = JSON.parse(document.getElementById('pages').textContent);
  const field = document.getElementById('q');
  const list = document.getElementById('found');
  const count = document.getElementById('count');
  const MOST = 40;

  // Whether a word of a heading begins so.
  const has = (text, word) => text.toLowerCase().split(/[^\p{L}\p{N}_-]+/u).some(one => one.startsWith(word));

  // How well a page fits a word: by its title, by a heading, by its text; 0 where it has none of it.
  function fit([, title, headings, words], word) {
    const name = title.toLowerCase();
    if (name === word) return 100;
    if (name.split(/[^a-z0-9]+/).includes(word)) return 40;
    if (name.includes(word)) return 20;
    if (headings.some(([, text]) => has(text, word))) return 8;
    return (' ' + words).includes(' ' + word) ? 1 : 0;
  }

  function search() {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    history.replaceState(null, '', '#' + new URLSearchParams(words.length ? [['q', field.value]] : []).toString());
    const found = [];
    for (const page of words.length ? pages : []) {
      const fits = words.map(word => fit(page, word));
      if (fits.every(Boolean)) found.push([fits.reduce((a, b) => a + b), page]);
    }
    found.sort((a, b) => b[0] - a[0]);
    list.replaceChildren(...found.slice(0, MOST).map(([, [path, title, headings]]) => {
      const item = document.createElement('li');
      const link = document.createElement('a');
      link.href = path;
      link.textContent = title;
      item.append(link);
      for (const [id, text] of headings.filter(([, text]) => words.some(word => has(text, word))).slice(0, 3)) {
        const below = document.createElement('a');
        below.href = `${path}#${id}`;
        below.textContent = text;
        item.append(' · ', below);
      }
      return item;
    }));
    count.textContent = words.length ? `${found.length} of ${pages.length} pages` : '';
  }

  field.addEventListener('input', search);
  // A bare fragment, typed by hand, is what is looked for, too.
  function restore() {
    const hash = location.hash.slice(1);
    field.value = hash.includes('=') ? new URLSearchParams(hash).get('q') || '' : decodeURIComponent(hash);
    search();
  }
  addEventListener('hashchange', restore);
  restore();
  field.focus();
})();
