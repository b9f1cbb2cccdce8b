// Keys, and what the menu does.
const KEYS = [
  ['Arrows', 'move'], ['Home, End', 'first and last image'], ['Page up, Page down', 'a page'], ['Enter', 'open the image'],
  ['Escape', 'close'], ['/', 'find in ids'], ['[ and ], arrows', 'image before and after, of an open one'], ['+ and -', 'size of the pictures'],
  ['m', 'masks'], ['b', 'boxes'], ['d', 'depth'], ['n', 'normals'], ['c', 'cut out'], ['x', '3D box and axes'], ['p', 'plots'], ['?', 'this list'],
];
const THEMES = ['system', 'light', 'dark'];

function say(text) {
  const said = $('said');
  said.textContent = text;
  clearTimeout(say.timer);
  say.timer = setTimeout(() => { said.textContent = ''; }, 4000);
}

// As a shell's word: in quotes where it has to be.
const shellWord = text => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function copyText(text) {
  const lines = text.split('\n').length, told = () => say(lines > 1 ? `${lines} lines copied` : `Copied: ${text}`);
  const byHand = () => {
    const field = el('textarea', {value: text, className: 'copy'});
    (document.querySelector('dialog[open]') || document.body).append(field);
    field.select();
    const done = document.execCommand('copy');
    field.remove();
    if (done) told();
    else say('This browser does not let the page copy');
  };
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(told, byHand);
  else byHand();
}

// The filters as `dsbuild export` takes them; what it has no option for is said.
function exportCommand() {
  const words = ['dsbuild export . --format coco -o', shellWord(`../${data.meta.name}-coco`)], left = [];
  for (const [key, values] of state.lists) {
    const names = [...values].map(v => data.columns.get(key).values[v]);
    for (const name of names) words.push(key === 'split' ? `--split ${shellWord(name)}` : `--filter ${shellWord(`${key}=${name}`)}`);
    if (!['class', 'split', 'model', 'material', 'environment', 'view'].includes(key)) left.push(data.columns.get(key).label);
  }
  for (const key of state.ranges.keys()) left.push(data.columns.get(key).label);
  if (state.text !== '') left.push('text');
  if (state.finding >= 0) left.push('check');
  if (state.sample > 0) left.push('sample');
  return words.join(' ') + (left.length > 0 ? `  # without: ${left.join(', ')}` : '');
}

function showWords(title, ...content) {
  $('words-title').textContent = title;
  $('words-body').replaceChildren(...content);
  $('words').showModal();
}

function showAbout() {
  const meta = data.meta, table = el('table', {});
  const row = (name, text) => table.append(el('tr', {}, el('th', {scope: 'row', textContent: name}), el('td', {textContent: text})));
  row('dataset', meta.name);
  if (meta.licence) row('licence', meta.licence);
  row('made by', `dsbuild ${meta.version}`);
  for (const [name, count] of Object.entries(meta.counts)) row(name, count);
  for (const [name, text] of Object.entries(meta.conventions)) row(name.replaceAll('_', ' '), text);
  for (const [name, text] of Object.entries(meta.planes || {})) row(`plane ${name}`, text);
  for (const note of meta.notes) row('note', note);
  const files = el('p', {}, ...['manifest/dataset.json', 'manifest/images.jsonl'].flatMap(file => [el('a', {href: address(`${meta.root}/${file}`), textContent: file}), ' ']));
  showWords('About this dataset', table, files, el('details', {}, el('summary', {textContent: 'Recipe'}), el('pre', {textContent: meta.recipe})));
}

function showHelp() {
  showWords('Keys', el('table', {}, ...KEYS.map(([key, words]) => el('tr', {}, el('th', {scope: 'row'}, el('kbd', {textContent: key})), el('td', {textContent: words})))));
}

function setTheme(theme) {
  if (theme === 'system') delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
}

function switchTheme() {
  const theme = THEMES[(THEMES.indexOf(document.documentElement.dataset.theme || 'system') + 1) % 3];
  setTheme(theme);
  try { localStorage.setItem('dsbuild-theme', theme); } catch { /* a browser may keep nothing for pages of the disk */ }
  say(`Colours: ${theme}`);
}

const MOST_PRINTED = 200;
// What is printed: at most 200 of what is shown, with the filters as text.
function fillSheet() {
  const order = [...shown.order.subarray(0, MOST_PRINTED)], words = filtersInUse().map(([text]) => text).join('; ');
  const left = shown.order.length - order.length;
  $('sheet').replaceChildren(
    el('h1', {textContent: data.meta.name}),
    el('p', {textContent: `${shown.order.length} of ${data.n} images${left > 0 ? `, the first ${MOST_PRINTED} of them here` : ''}${words ? `. ${words}` : ''}`}),
    el('div', {className: 'prints'}, ...order.map(i => el('figure', {}, el('img', {src: thumbnail(i), alt: nameOf(i)}), el('figcaption', {textContent: captionOf(i).join('\n')})))));
}

async function printSheet() {
  fillSheet();
  await Promise.allSettled([...$('sheet').querySelectorAll('img')].map(image => image.decode()));
  window.print();
}

const ACTIONS = {
  ids: () => copyText([...shown.order].map(i => data.ids[i]).join('\n')),
  export: () => copyText(exportCommand()),
  sample: () => {
    state.seed = state.sample > 0 ? state.seed + 1 : state.seed;
    state.sample = 100;
    changed();
  },
  print: printSheet, theme: switchTheme, about: showAbout, help: showHelp,
};

function openMenu(open) {
  $('menu').hidden = !open;
  $('more').setAttribute('aria-expanded', open);
  if (open) $('menu').firstElementChild.focus();
}

function menuKeys(event) {
  const items = [...$('menu').children], at = items.indexOf(document.activeElement);
  if (event.key === 'Escape') {
    openMenu(false);
    $('more').focus();
  } else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
    items[(at + (event.key === 'ArrowDown' ? 1 : items.length - 1)) % items.length].focus();
  } else {
    return;
  }
  event.preventDefault();
  event.stopPropagation();
}

function setSize(size) {
  state.size = size;
  changed({lay: true});
}

// Keys of the grid: they move the cursor wherever the focus is, but in fields.
function gridKey(key) {
  const at = grid.cursor, page = Math.max(1, Math.floor(grid.height / cellHeight()));
  const pages = direction => {
    let place = at;
    for (let k = 0; k < page; ++k) place = placeBeside(place, direction);
    return place;
  };
  const moves = {
    ArrowLeft: () => at - 1, ArrowRight: () => at + 1, ArrowUp: () => placeBeside(at, -1), ArrowDown: () => placeBeside(at, 1),
    Home: () => 0, End: () => shown.order.length - 1, PageUp: () => pages(-1), PageDown: () => pages(1),
  };
  if (moves[key]) moveCursor(moves[key]());
  else if (key === 'Enter' && shown.order.length > 0) openPicture(shown.order[grid.cursor]);
  else return false;
  return true;
}

function pageKey(key) {
  const sizes = [64, 128, 256], at = sizes.indexOf(state.size);
  const acts = {
    '/': () => $('text').focus(), m: () => toggleState('mask'), b: () => toggleState('boxes'), p: () => toggleState('plots'),
    '+': () => setSize(sizes[Math.min(2, at + 1)]), '=': () => setSize(sizes[Math.min(2, at + 1)]), '-': () => setSize(sizes[Math.max(0, at - 1)]), '?': showHelp,
  };
  if (!acts[key]) return false;
  acts[key]();
  return true;
}

function pictureKey(key) {
  const has = kind => picture.line && (picture.line.previews || []).includes(kind);
  // Of a picture larger than its place the arrows show the rest.
  if (key.startsWith('Arrow') && $('stage').scrollWidth > $('stage').clientWidth) return false;
  const normals = ['shading_normal', 'geometry_normal'].find(has), depth = ['depth', 'distance'].find(has);
  const acts = {
    '[': () => stepPicture(-1), ']': () => stepPicture(1), ArrowLeft: () => stepPicture(-1), ArrowRight: () => stepPicture(1), m: () => toggleLook('mask'), b: () => toggleLook('box'), c: () => toggleLook('cut'),
    x: () => toggleLook('box3'), d: () => depth && setBase(depth), n: () => normals && setBase(normals), '?': showHelp,
  };
  if (!acts[key]) return false;
  acts[key]();
  return true;
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  const target = event.target, inField = target.closest('input, select, textarea');
  if (inField && !(event.key === 'Escape')) return;
  let done = false;
  if (document.querySelector('#words[open]')) return;
  if ($('picture').open) done = pictureKey(event.key);
  else if (event.key === 'Escape' && inField) {
    target.blur();
    done = true;
  } else if (target.closest('#canvas') || target === document.body) done = gridKey(event.key) || pageKey(event.key);
  else done = pageKey(event.key);
  if (done) event.preventDefault();
}

function setUpKeys() {
  document.addEventListener('keydown', onKey);
  $('menu').addEventListener('keydown', menuKeys);
  $('more').addEventListener('click', () => openMenu($('menu').hidden));
  document.addEventListener('click', event => {
    if (!$('menu').hidden && !event.target.closest('#menu, #more')) openMenu(false);
  });
  $('menu').addEventListener('click', event => {
    const item = event.target.closest('[data-do]');
    if (!item) return;
    openMenu(false);
    $('more').focus();
    ACTIONS[item.dataset.do]();
  });
  for (const button of document.querySelectorAll('[data-close]')) button.addEventListener('click', () => button.closest('dialog').close());
  window.addEventListener('beforeprint', fillSheet);
  window.addEventListener('afterprint', () => $('sheet').replaceChildren());
}
