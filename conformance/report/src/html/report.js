'use strict';
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const state = () => location.hash.includes('=') ? new URLSearchParams(location.hash.slice(1)) : new URLSearchParams(location.hash.length > 1 ? [['card', location.hash.slice(1)]] : []);

  // Filters: what they are set to stands in the address, so that a view can be sent to somebody.
  const form = document.getElementById('filters');
  const fields = form ? all('input[name], select[name]', form) : [];
  const rows = all('#matrix tbody tr');
  const cells = rows.map(row => all('td', row));
  const heads = all('#matrix thead th[data-subject]');

  function filter() {
    const values = Object.fromEntries(fields.map(field => [field.name, field.value]));
    const words = (values.q || '').toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = values.subject || '';
    for (const cell of heads.concat(...cells)) cell.hidden = wanted !== '' && cell.dataset.subject !== wanted;
    let shown = 0;
    rows.forEach((row, k) => {
      const name = row.firstElementChild.textContent.toLowerCase();
      const fits = words.every(word => name.includes(word))
        && (!values.family || row.dataset.family === values.family)
        && (!values.show || cells[k].some(cell => !cell.hidden && cell.className === values.show));
      row.hidden = !fits;
      shown += fits;
    });
    const count = document.getElementById('count');
    if (count) count.textContent = `${shown} of ${rows.length}`;
  }

  function remember(card) {
    const params = new URLSearchParams();
    for (const field of fields) if (field.value) params.set(field.name, field.value);
    if (card) params.set('card', card);
    history.replaceState(null, '', '#' + params.toString());
  }

  // Cards: opened by a link, by j and k, or by their heads.
  const cards = all('details.card');
  let current = -1;
  function show(card) {
    current = cards.indexOf(card);
    card.open = true;
    card.scrollIntoView({ block: 'start' });
    card.querySelector('summary').focus({ preventScroll: true });
    remember(card.id);
  }

  function restore() {
    const params = state();
    for (const field of fields) field.value = params.get(field.name) || '';
    filter();
    const card = params.get('card') && document.getElementById(params.get('card'));
    if (card && card.matches('details.card')) show(card);
  }

  if (form) {
    form.addEventListener('input', () => { filter(); remember(); });
    form.addEventListener('submit', event => event.preventDefault());
  }
  addEventListener('hashchange', restore);
  document.addEventListener('click', event => {
    const link = event.target.closest('a[href^="#fails-"]');
    const card = link && document.getElementById(link.getAttribute('href').slice(1));
    if (card) { event.preventDefault(); show(card); }
    const copy = event.target.closest('button[data-copy]');
    if (copy) {
      const done = () => { copy.textContent = 'copied'; };
      if (navigator.clipboard) navigator.clipboard.writeText(copy.dataset.copy).then(done, () => {});
    }
  });
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select, textarea')) return;
    if (event.key === '/' && form) { event.preventDefault(); document.getElementById('q').focus(); }
    const step = { j: 1, k: -1 }[event.key];
    if (step && cards.length) show(cards[Math.min(Math.max(current + step, 0), cards.length - 1)]);
  });

  // Scenes: the slider, the marked pixels, and the values of the pixel that is pointed at.
  for (const card of all('details.scene')) {
    const slider = card.querySelector('.slider');
    if (!slider) continue;
    const told = JSON.parse(card.querySelector('script.pixels').textContent);
    const range = card.querySelector('input[type="range"]');
    const [reference, result] = ['reference', 'result'].map(name => card.querySelector('img.' + name));
    const output = card.querySelector('output.pixel');
    const line = card.querySelector('.cut');
    const cut = () => {
      reference.style.clipPath = `inset(0 ${100 - range.value}% 0 0)`;
      line.style.left = `${range.value}%`;
    };
    range.addEventListener('input', cut);
    cut();

    const marks = card.querySelector('canvas.marks');
    card.querySelector('input.marked').addEventListener('change', event => {
      marks.width = slider.dataset.width;
      marks.height = slider.dataset.height;
      const draw = marks.getContext('2d');
      if (!event.target.checked) return;
      for (const [x, y, , , , , marked] of told) {
        draw.fillStyle = marked ? '#2f81f7' : '#ff00ff';
        draw.fillRect(x, y, 1, 1);
      }
    });

    const bytes = new Map();
    const at = (image, x, y) => {
      if (!bytes.has(image)) {
        const canvas = document.createElement('canvas');
        canvas.width = image.naturalWidth;
        canvas.height = image.naturalHeight;
        const draw = canvas.getContext('2d', { willReadFrequently: true });
        draw.drawImage(image, 0, 0);
        bytes.set(image, draw);
      }
      return [...bytes.get(image).getImageData(x, y, 1, 1).data].join(' ');
    };
    const tell = (x, y) => {
      const lines = [`pixel ${x}, ${y}    reference ${at(reference, x, y)}    drawn ${at(result, x, y)}    (8 bits)`];
      const pixel = told.find(one => one[0] === x && one[1] === y);
      if (pixel) {
        const [, , exact, low, high, value, marked] = pixel;
        lines.push(`reference  ${exact.join('  ')}`, `legal from ${low.join('  ')}`, `to         ${high.join('  ')}`, `drawn      ${value.join('  ')}`);
        if (marked) lines.push('several outcomes are legal here');
      }
      output.textContent = lines.join('\n');
    };
    slider.addEventListener('pointermove', event => {
      const box = slider.getBoundingClientRect();
      const [width, height] = [Number(slider.dataset.width), Number(slider.dataset.height)];
      const x = Math.min(width - 1, Math.max(0, Math.floor((event.clientX - box.left) / box.width * width)));
      const y = Math.min(height - 1, Math.max(0, Math.floor((event.clientY - box.top) / box.height * height)));
      tell(x, y);
    });
    for (const button of all('table.worst button', card)) {
      button.addEventListener('click', () => tell(Number(button.dataset.x), Number(button.dataset.y)));
    }
  }

  restore();
})();
