// One image: its picture with labels drawn in, and all that the manifest says of it.
const picture = {image: -1, line: null, base: 'image', on: new Set(['box']), zoom: 'fit'};
const ZOOMS = ['fit', '1', '2', '4'];
const BASE_WORDS = {image: 'Picture', depth: 'Depth', distance: 'Distance', shading_normal: 'Normals', geometry_normal: 'Facets'};

function openPicture(i) {
  picture.image = i;
  picture.line = null;
  state.image = i;
  $('picture-title').textContent = data.ids[i];
  const place = shown.order.indexOf(i);
  $('place').textContent = place >= 0 ? `${place + 1} of ${shown.order.length}` : 'not among what is shown';
  $('before').disabled = place <= 0;
  $('after').disabled = place < 0 || place + 1 >= shown.order.length;
  if (!$('picture').open) $('picture').showModal();
  withLine(i, line => {
    if (picture.image !== i) return;
    picture.line = line;
    drawPicture();
    drawFacts();
  });
  writeHash();
}

function stepPicture(direction) {
  const place = shown.order.indexOf(picture.image) + direction;
  if (place - direction < 0 || place < 0 || place >= shown.order.length) return;
  moveCursor(place, false);
  openPicture(shown.order[place]);
}

function pictureClosed() {
  state.image = -1;
  picture.image = -1;
  writeHash();
  const place = shown.order.length > 0 ? grid.cursor : -1;
  if (place >= 0) moveCursor(place);
}

function toggleLook(name) {
  if (!picture.on.delete(name)) picture.on.add(name);
  if (picture.line) drawPicture();
}

function setBase(kind) {
  picture.base = picture.base === kind ? 'image' : kind;
  if (picture.line) drawPicture();
}

// What can be drawn of this image: [key, words, whether it is on, what a click does].
function looks() {
  const {line, image, on} = picture, list = [];
  const kinds = line.previews || [];
  const bases = ['image', ...kinds].filter(kind => kind !== 'image' || fileOf(image, 'image'));
  if (bases.length > 1)
    for (const kind of bases) list.push([BASE_WORDS[kind] || kind.replaceAll('_', ' '), picture.base === kind, () => setBase(kind)]);
  for (const [name, words, there] of [['mask', 'Mask', fileOf(image, 'mask')], ['amodal', 'Amodal mask', fileOf(image, 'amodal_mask')], ['cut', 'Cut out', fileOf(image, 'mask')], ['box', 'Box', line.box || boxOf(image)], ['box3', '3D box, axes', worldBox(line)]])
    if (there) list.push([words, on.has(name), () => toggleLook(name)]);
  return list;
}

function drawPicture() {
  const {line, image, on} = picture, stage = $('stage');
  const kinds = line.previews || [];
  if (picture.base !== 'image' && !kinds.includes(picture.base)) picture.base = 'image';
  const base = picture.base === 'image' ? fileOf(image, 'image') || thumbnail(image) : preview(image, picture.base);
  const layers = el('div', {className: 'layers'});
  const add = (source, name, alt) => {
    const node = el('img', {className: name, src: source, alt, draggable: false});
    node.onerror = () => layers.classList.add('broken');
    layers.append(node);
  };
  add(base, 'base', nameOf(image));
  if (on.has('cut') && fileOf(image, 'mask')) add(fileOf(image, 'mask'), 'cut', '');
  if (on.has('amodal') && fileOf(image, 'amodal_mask')) add(fileOf(image, 'amodal_mask'), 'amodal', '');
  if (on.has('mask') && fileOf(image, 'mask')) add(fileOf(image, 'mask'), 'mask', '');
  const drawing = svg('svg', {viewBox: `0 0 ${line.width} ${line.height}`, preserveAspectRatio: 'none', 'aria-hidden': 'true'});
  const box = boxOf(image);
  if (on.has('box3')) drawing.append(...boxOverPicture(line));
  layers.append(drawing);
  // Of the model, and of what stands beside it.
  const frame = (box, of, kind) => {
    drawing.append(svg('rect', {x: box[0], y: box[1], width: box[2], height: box[3], class: `box ${kind}`}));
    const name = of.class_path || of.model, label = el('span', {className: `box-label ${kind}`, textContent: name.slice(name.lastIndexOf('/') + 1)});
    label.style.left = `${100 * box[0] / line.width}%`;
    label.style.top = `${100 * box[1] / line.height}%`;
    layers.append(label);
  };
  if (on.has('box')) {
    for (const object of line.objects || []) if (object.box) frame(object.box, object, 'other');
    if (box) frame(box, line, '');
  }
  const room = Math.min((stage.clientWidth - 16) / line.width, (stage.clientHeight - 16) / line.height);
  // As large as there is room for; whole numbers where the picture is the smaller.
  const scale = picture.zoom === 'fit' ? (room >= 1 ? Math.max(1, Math.floor(room)) : room) : Number(picture.zoom);
  layers.style.width = `${line.width * scale}px`;
  layers.style.height = `${line.height * scale}px`;
  layers.classList.toggle('pixels', scale >= 1);
  stage.replaceChildren(layers);
  const buttons = looks().map(([words, pressed, act]) => {
    const button = el('button', {type: 'button', textContent: words, 'aria-pressed': pressed});
    button.addEventListener('click', () => {
      act();
      [...$('looks').querySelectorAll('button')].find(other => other.textContent === words)?.focus();
    });
    return button;
  });
  const zoom = el('select', {'aria-label': 'Zoom'}, ...ZOOMS.map(value => el('option', {value, textContent: value === 'fit' ? 'Fit' : `${value}00 %`, selected: value === picture.zoom})));
  zoom.addEventListener('change', () => {
    picture.zoom = zoom.value;
    drawPicture();
    $('looks').querySelector('select').focus();
  });
  const file = fileOf(image, 'image');
  const link = file ? [el('a', {href: file, textContent: 'Open the file', target: '_blank'})] : [];
  $('looks').replaceChildren(...buttons, zoom, ...link);
}

const vector = numbers => numbers.map(shortNumber).join(', ');

// [name, text, button words and what it does ...] of each row.
function factRows(line) {
  const pose = line.camera_to_world, at = pose.slice(0, 3).map(row => row[3]), look = pose.slice(0, 3).map(row => row[2]);
  const percent = value => (value === null || value === undefined ? 'not known' : `${shortNumber(value * 100)} %`);
  const film = line.film || {}, pixels = line.width * line.height, counts = line.pixel_counts || {};
  const same = (key, words) => [words, () => {
    clearFilters();
    const column = data.columns.get(key);
    state.lists.set(key, new Set([column.of[picture.image]]));
    $('picture').close();
    changed();
  }];
  const filter = (key, words) => (data.columns.has(key) ? [same(key, words)] : []);
  const copy = text => ['Copy', () => copyText(text)];
  const rows = [
    ['id', line.id, [copy(line.id)]],
    ['class', line.class_path, filter('class', 'Same class')], ['split', line.split, []], ['model', line.model, filter('model', 'Same model')],
    ['material', line.material, filter('material', 'Same material')], ['environment', line.environment, filter('environment', 'Same environment')],
    ['view', line.view, filter('view', 'Same view')],
    ['size', `${line.width} x ${line.height} pixels`, []],
    ['relative error', `${percent(line.relative_error)}${film.error_low ? `, 95 % between ${percent(film.error_low)} and ${percent(film.error_high)}` : ''}${film.capped ? ' (ended by max_spp)' : ''}`, []],
    ['samples', film.samples ? `${shortNumber(film.samples / pixels)} a pixel` : `${line.spp} a pixel`, []],
    ['rejected samples', line.rejected_samples, []],
    ['camera at', `${vector(at)} m`, []], ['looks along', vector(look), []],
    ['field of view', !line.intrinsics ? '' : `${shortNumber(2 * Math.atan(Math.max(line.width, line.height) / 2 / line.intrinsics[0][0]) * 180 / Math.PI)} degrees`, []],
    ['lens radius', line.lens_radius_m ? `${shortNumber(line.lens_radius_m)} m, sharp at ${shortNumber(line.focus_distance_m)} m` : '', []],
    ['box', line.box ? `x ${line.box[0]}, y ${line.box[1]}, ${line.box[2]} x ${line.box[3]} pixels` : '', []],
    ['box of the model', line.box_m ? line.box_m.map(p => (Array.isArray(p) ? vector(p) : shortNumber(p))).join(' to ') : '', []],
    ['mask', counts.model === undefined ? '' : `${percent(counts.model / pixels)} of the picture${counts.frame ? `, ${counts.frame} pixels of it on the border` : ''}`, []],
    ['visible fraction', line.visible_fraction === undefined ? '' : percent(line.visible_fraction), []],
    ['truncation', line.truncation === undefined ? '' : percent(line.truncation), []],
    ['occlusion', line.occlusion === undefined ? '' : percent(line.occlusion), []],
    ['seed', line.seed, []], ['tone map', `factor ${shortNumber(line.tone_map_scale)}`, []],
  ];
  for (const object of line.objects || [])
    rows.push([`object ${object.id}`, [object.model, object.class_path, object.material, object.visible_fraction === undefined ? '' : `${percent(object.visible_fraction)} visible`].filter(text => text).join(', '), []]);
  for (const [name, value] of Object.entries(line.draws || {})) rows.push([`drawn: ${name}`, Array.isArray(value) ? vector(value) : String(value), []]);
  const assets = [`models/${line.model}`, `materials/${line.material}`, `environments/${line.environment}`];
  const ofAssets = records => (records || []).filter(record => record.assets.some(asset => assets.some(own => asset === own || asset.startsWith(`${own}.`))));
  const licences = ofAssets(data.meta.licences);
  rows.push(['licences', [...new Set(licences.map(licence => licence.spdx || 'no SPDX id'))].join(', '), []]);
  rows.push(['sources', ofAssets(data.meta.sources).map(source => source.url || source.text.trim().split('\n')[0]).join('\n'), []]);
  rows.push(['render key', line.render_key, [copy(line.render_key)]]);
  for (const file of line.files) rows.push([file.kind, `${file.path}\n${file.xxh128}`, [copy(file.path)]]);
  const explain = `dsbuild explain . ${line.id.startsWith('-') ? '-- ' : ''}${shellWord(line.id)}`;
  rows.push(['why it was made', `${explain}\nin the dataset's folder`, [copy(explain)]]);
  return rows.filter(([, text]) => text !== '' && text !== undefined && text !== null);
}

function drawFacts() {
  const {line} = picture, table = el('table', {});
  for (const [name, text, buttons] of factRows(line)) {
    const cell = el('td', {}, el('span', {textContent: text}));
    for (const [words, act] of buttons) {
      const button = el('button', {type: 'button', className: 'link', textContent: words, 'aria-label': `${words}: ${name}`});
      button.addEventListener('click', act);
      cell.append(' ', button);
    }
    table.append(el('tr', {}, el('th', {scope: 'row', textContent: name}), cell));
  }
  const pose = poseView(line);
  $('facts').replaceChildren(...(pose ? [pose] : []), table);
  $('facts').scrollTop = 0;
}

function setUpPicture() {
  const dialog = $('picture');
  dialog.addEventListener('close', pictureClosed);
  $('before').addEventListener('click', () => stepPicture(-1));
  $('after').addEventListener('click', () => stepPicture(1));
  new ResizeObserver(() => {
    if (dialog.open && picture.line && picture.zoom === 'fit') drawPicture();
  }).observe(dialog);
}
