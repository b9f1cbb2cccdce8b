'use strict';
// What the data files hold. Each is a script that calls a function of `gallery`: of a page that was opened from the disk
// browsers read no file in another way.
const data = {meta: null, n: 0, ids: [], columns: new Map(), box: null, chunks: [], lines: new Map(), paths: {}};

const gallery = {
  meta(meta) {
    data.meta = meta;
    data.n = meta.n;
    data.box = new Int32Array(4 * meta.n).fill(-1);
    data.ids = new Array(meta.n);
    data.chunks = new Array(Math.ceil(meta.n / meta.chunk)).fill(false);
    data.broken = new Set(meta.broken);
    for (const column of meta.columns) {
      column.of = column.type === 'list' ? new Uint32Array(meta.n) : new Float64Array(meta.n).fill(NaN);
      data.columns.set(column.key, column);
    }
  },
  grid(chunk, columns) {
    const from = chunk * data.meta.chunk;
    for (let i = 0; i < columns.id.length; ++i) data.ids[from + i] = columns.id[i];
    data.box.set(columns.box, 4 * from);
    for (const [key, column] of data.columns) {
      const values = columns[key];
      for (let i = 0; i < values.length; ++i) column.of[from + i] = values[i] === null ? NaN : values[i];
    }
    for (const kind in columns.paths) Object.assign(data.paths[kind] ||= {}, columns.paths[kind]);
    data.chunks[chunk] = true;
  },
  image(chunk, lines) {
    data.lines.set(chunk, lines);
  },
};

const $ = id => document.getElementById(id);

// An element; `properties` are set as they are, those with a dash as attributes.
function el(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes('-') || key === 'role') node.setAttribute(key, value);
    else node[key] = value;
  }
  node.append(...children);
  return node;
}

function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

function complain(text) {
  const trouble = $('trouble');
  trouble.append(el('p', {textContent: text}));
  trouble.hidden = false;
  $('app').hidden = false;
}

// `there` says whether the file did what it should: a damaged one loads, too, and does nothing.
function load(file, there, done) {
  const script = el('script', {src: file, async: true});
  script.onerror = () => complain(`${file} cannot be read: it is missing, or this page was moved without its folder.`);
  script.onload = () => {
    script.remove();
    if (there()) done();
    else complain(`${file} is damaged: dsbuild gallery writes it again.`);
  };
  document.head.append(script);
}

const address = path => path.split('/').map(encodeURIComponent).join('/').replaceAll('%2E%2E', '..');

const digits = (number, count) => String(number).padStart(count, '0');
const stem = i => `${digits(Math.floor(i / 1000), 2)}/${digits(i, 5)}`;
const thumbnail = i => `t/${stem(i)}.jpg`;
const preview = (i, kind) => `p/${stem(i)}.${kind}.jpg`;

// Address of the image's file of that kind in the dataset; null where it has none.
function fileOf(i, kind) {
  const odd = data.paths[kind] && data.paths[kind][i];
  if (odd === null) return null;
  const known = data.meta.kinds.find(row => row.kind === kind);
  if (odd === undefined && !known) return null;
  return address(`${data.meta.root}/${odd || `images/${data.ids[i]}${known.ending}`}`);
}

function boxOf(i) {
  return data.box[4 * i] < 0 ? null : data.box.subarray(4 * i, 4 * i + 4);
}

function valueOf(i, key) {
  const column = data.columns.get(key);
  if (!column) return '';
  return column.type === 'list' ? column.values[column.of[i]] : column.of[i];
}

// The image's line of the manifest, when it is there.
function withLine(i, done) {
  const size = data.meta.image_chunk, chunk = Math.floor(i / size);
  const tell = () => done(data.lines.get(chunk)[i % size]);
  if (data.lines.has(chunk)) tell();
  else load(`data/image-${digits(chunk, 3)}.js`, () => data.lines.has(chunk), tell);
}

function shortNumber(value) {
  if (!Number.isFinite(value)) return 'not known';
  const text = Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  return text.replace('e+', 'e');
}

// With its unit; shares as per cent.
function numberText(column, value) {
  if (!Number.isFinite(value)) return 'not known';
  if (column.unit === 'share') return `${shortNumber(value * 100)} %`;
  return column.unit ? `${shortNumber(value)} ${column.unit}` : shortNumber(value);
}

// Of each path its last names, as many as tell it from the others that end alike.
function shortNames(paths) {
  const endings = path => path.split('/').map((_, k, parts) => parts.slice(parts.length - 1 - k).join('/'));
  const counts = new Map();
  for (const path of paths) for (const ending of endings(path)) counts.set(ending, (counts.get(ending) || 0) + 1);
  return new Map(paths.map(path => [path, endings(path).find(ending => counts.get(ending) === 1) || path]));
}

// "mug" of the image's class, or else of its model.
const shorts = new Map();
function shortNameOf(i) {
  const key = ['class', 'model'].find(one => valueOf(i, one));
  if (!key) return data.ids[i].slice(data.ids[i].lastIndexOf('/') + 1);
  const column = data.columns.get(key);
  if (!shorts.has(key)) shorts.set(key, shortNames([...new Set(column.type === 'list' ? column.values : column.of)]));
  return shorts.get(key).get(valueOf(i, key));
}

// "mug, red plastic, studio, view 3".
function nameOf(i) {
  const parts = [valueOf(i, 'class') || valueOf(i, 'model') ? shortNameOf(i) : '', valueOf(i, 'material').replaceAll('-', ' '), valueOf(i, 'environment')];
  const view = valueOf(i, 'view');
  if (view !== '') parts.push(`view ${view}`);
  return parts.filter(part => part !== '').join(', ') || data.ids[i];
}
