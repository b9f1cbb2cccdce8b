// The filters beside the grid: a list of values with counts or a histogram with two handles for each column.
const LISTED = 10, MOST_LISTED = 100, OPEN_AT_FIRST = ['class', 'split', 'material', 'environment', 'error'];
const panel = {facets: []};

function setUpPanel() {
  const holder = $('panel');
  if (data.meta.checks.length > 0) holder.append(findingsFacet());
  for (const column of data.columns.values()) {
    const body = el('div', {className: 'facet-body'});
    const facet = el('details', {className: 'facet', open: OPEN_AT_FIRST.includes(column.key)}, el('summary', {textContent: column.label}), body);
    facet.dataset.key = column.key;
    const entry = {column, facet, body, draw: null, search: '', all: false};
    facet.addEventListener('toggle', () => drawFacet(entry));
    panel.facets.push(entry);
    holder.append(facet);
  }
}

function drawPanel() {
  for (const entry of panel.facets) drawFacet(entry);
  for (const button of document.querySelectorAll('#panel [data-finding]')) button.setAttribute('aria-pressed', Number(button.dataset.finding) === state.finding);
}

function drawFacet(entry) {
  entry.facet.classList.toggle('used', state.lists.has(entry.column.key) || state.ranges.has(entry.column.key));
  if (!entry.facet.open) return entry.body.replaceChildren();
  if (entry.column.type === 'list') drawList(entry);
  else drawHistogram(entry);
}

function drawList(entry) {
  const {column, body} = entry, counts = countsOf(column), chosen = state.lists.get(column.key) || new Set();
  const wanted = entry.search.toLowerCase();
  const values = [];
  column.values.forEach((name, v) => {
    if (name.toLowerCase().includes(wanted)) values.push(v);
  });
  const most = entry.all ? MOST_LISTED : LISTED;
  // Chosen ones stay in sight however many there are.
  const listed = values.slice(0, most);
  for (const v of chosen) if (!listed.includes(v) && values.includes(v)) listed.push(v);
  let list = body.querySelector('.values');
  if (!list) {
    list = el('div', {className: 'values', role: 'group', 'aria-label': column.label});
    if (column.values.length > LISTED) {
      const search = el('input', {type: 'search', placeholder: `Find in ${column.values.length} values`, value: entry.search, 'aria-label': `Find in ${column.label}`});
      search.addEventListener('input', () => {
        entry.search = search.value;
        drawList(entry);
      });
      body.append(search);
    }
    body.append(list);
  }
  const focused = document.activeElement && list.contains(document.activeElement) ? document.activeElement.dataset.value : null;
  list.replaceChildren(...listed.map(v => {
    const box = el('input', {type: 'checkbox', checked: chosen.has(v)});
    box.dataset.value = v;
    box.addEventListener('change', () => {
      toggleValue(column.key, v);
      changed();
    });
    return el('label', {className: counts[v] === 0 ? 'none' : ''}, box, el('span', {textContent: column.values[v] || 'none'}), el('b', {textContent: counts[v]}));
  }));
  if (values.length > listed.length) {
    const rest = values.length - listed.length;
    const more = el('button', {type: 'button', className: 'link', textContent: entry.all ? `${rest} more: find them above` : `Show ${Math.min(rest, MOST_LISTED - LISTED)} more`, disabled: entry.all});
    more.addEventListener('click', () => {
      entry.all = true;
      drawList(entry);
    });
    list.append(more);
  }
  if (focused !== null) list.querySelector(`[data-value="${focused}"]`)?.focus();
}

// A path of bars, from the bottom.
function barsPath(counts, most, width, height) {
  let path = '';
  for (let k = 0; k < counts.length; ++k) {
    const tall = counts[k] === 0 ? 0 : Math.max(1, counts[k] / most * height);
    if (tall > 0) path += `M${(k * width / counts.length).toFixed(1)} ${height}v${(-tall).toFixed(1)}h${(width / counts.length - 0.6).toFixed(1)}v${tall.toFixed(1)}z`;
  }
  return path;
}

const STEPS = 1000;

function makeHistogram(entry) {
  const {column, body} = entry;
  const drawing = svg('svg', {viewBox: '0 0 240 48', preserveAspectRatio: 'none', class: 'histogram', role: 'img'});
  const all = svg('path', {class: 'all'}), left = svg('path', {class: 'left'});
  drawing.append(all, left);
  const handles = ['least', 'greatest'].map(which => el('input', {type: 'range', min: 0, max: STEPS, step: 1, 'aria-label': `${which} ${column.label}`}));
  const words = el('output', {});
  const move = () => {
    const [low, high] = rangeOf(column), value = handle => low + (high - low) * Number(handle.value) / STEPS;
    let [a, b] = handles.map(value);
    if (a > b) [a, b] = [b, a];
    // Whole steps may miss the ends by rounding.
    setRange(column.key, Number(handles[0].value) === 0 ? low : a, Number(handles[1].value) === STEPS ? high : b);
    changed();
  };
  for (const handle of handles) handle.addEventListener('input', move);
  body.append(el('div', {className: 'range'}, drawing, ...handles), words);
  entry.draw = () => {
    const bars = barsOf(column), most = Math.max(1, ...bars.all), [a, b] = state.ranges.get(column.key) || [bars.low, bars.high];
    all.setAttribute('d', barsPath(bars.all, most, 240, 48));
    left.setAttribute('d', barsPath(bars.left, most, 240, 48));
    const step = value => (bars.high > bars.low ? Math.round((value - bars.low) / (bars.high - bars.low) * STEPS) : 0);
    if (document.activeElement !== handles[0]) handles[0].value = step(a);
    if (document.activeElement !== handles[1]) handles[1].value = bars.high > bars.low ? step(b) : STEPS;
    handles.forEach((handle, k) => handle.setAttribute('aria-valuetext', numberText(column, [a, b][k])));
    words.textContent = a === b ? numberText(column, a) : `${numberText(column, a)} to ${numberText(column, b)}`;
    drawing.setAttribute('aria-label', `${column.label} of what is shown, from ${numberText(column, bars.low)} to ${numberText(column, bars.high)}`);
  };
}

function drawHistogram(entry) {
  if (!entry.body.firstChild) makeHistogram(entry);
  entry.draw();
}

function findingsFacet() {
  const list = el('div', {className: 'values'});
  data.meta.checks.forEach((finding, k) => {
    const level = el('i', {className: `level ${finding.level}`, textContent: finding.level});
    const words = `${finding.check}: ${finding.of > 0 ? `${finding.count} of ${finding.of} ` : ''}${finding.what}${finding.images.length === 0 && finding.examples.length > 0 ? `: ${finding.examples.join(', ')}` : ''}${finding.advice ? ` (${finding.advice})` : ''}`;
    if (finding.images.length === 0) return list.append(el('p', {className: 'finding'}, level, el('span', {textContent: words})));
    const button = el('button', {type: 'button', className: 'finding', 'aria-pressed': false}, level, el('span', {textContent: words}));
    button.dataset.finding = k;
    button.addEventListener('click', () => {
      state.finding = state.finding === k ? -1 : k;
      changed();
    });
    list.append(button);
  });
  return el('details', {className: 'facet', open: true}, el('summary', {textContent: `Checks (${data.meta.checks.length})`}), list);
}

// What is in use, above the grid: each a button that takes it away.
function drawChips() {
  const chips = filtersInUse().map(([words, remove]) => {
    const button = el('button', {type: 'button', className: 'chip', 'aria-label': `Take away the filter ${words}`}, el('span', {textContent: words}), '\u00a0\u2715');
    button.addEventListener('click', () => {
      remove();
      changed();
    });
    return button;
  });
  if (chips.length > 1) {
    const all = el('button', {type: 'button', className: 'chip', textContent: 'Take all away'});
    all.addEventListener('click', () => {
      clearFilters();
      changed();
    });
    chips.push(all);
  }
  $('chips').replaceChildren(...chips);
}
