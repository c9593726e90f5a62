// Put into the page before everything else: gathers errors, and when all is loaded pushes every button and looks at what came of it. What
// it found is told to the page around it: "ok at 400 px" or the first things that are wrong.
const wrong = [];
addEventListener('error', event => wrong.push('error: ' + event.message));
for (const method of ['error', 'warn']) {
  const said = console[method];
  console[method] = (...what) => { wrong.push(method + ': ' + what.join(' ')); said(...what); };
}
const keys = (table, column) => [...table.tBodies[0].rows].map(row => {
  const cell = row.cells[column];
  return cell.dataset.key !== undefined ? Number(cell.dataset.key) : null;
}).filter(key => key !== null);
const checkTables = () => {
  const tables = [...document.querySelectorAll('table.sortable')];
  if (tables.length < 4) wrong.push(tables.length + ' tables');
  for (const table of tables) {
    const rows = table.tBodies[0].rows.length;
    table.querySelectorAll('th').forEach((th, column) => {
      const button = th.querySelector('button');
      if (!button) return;
      for (const sign of [1, -1]) {
        button.click();
        const sorted = keys(table, column);
        if (sorted.some((key, i) => i > 0 && sign * (key - sorted[i - 1]) < 0))
          wrong.push(table.caption.textContent + ': column ' + th.textContent + ' is not sorted');
      }
      if (th.getAttribute('aria-sort') !== 'descending') wrong.push('two clicks do not sort downwards: ' + th.textContent);
    });
    if (table.tBodies[0].rows.length !== rows) wrong.push('sorting loses rows');
  }
};
const checkLinks = () => {
  for (const a of document.querySelectorAll('a[href^="#"]'))
    if (!document.getElementById(a.getAttribute('href').slice(1))) wrong.push('no place for ' + a.getAttribute('href'));
  const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
  if (new Set(ids).size !== ids.length) wrong.push('ids repeat: ' + ids.filter((id, i) => ids.indexOf(id) !== i).slice(0, 3));
  for (const element of document.querySelectorAll('[src],link[href]')) {
    const from = element.getAttribute('src') || element.getAttribute('href');
    if (!from.startsWith('data:')) wrong.push('not inside the page: ' + from);
  }
};
const checkLayout = () => {
  const over = document.documentElement.scrollWidth - innerWidth;
  if (over > 0) wrong.push('wider than the window of ' + innerWidth + ' px by ' + over);
  for (const chart of document.querySelectorAll('svg.chart')) {
    const box = chart.getBoundingClientRect();
    const text = chart.querySelector('text');
    if (box.width === 0 || !text) { wrong.push('an empty figure'); continue; }
    const size = parseFloat(getComputedStyle(text).fontSize) * box.width / chart.viewBox.baseVal.width;
    if (size < 9) wrong.push('letters of ' + size.toFixed(1) + ' px in a figure');
  }
};
const checkContents = () => {
  const contents = document.querySelector('.contents');
  const studies = document.querySelectorAll('article[id] > h3').length;
  if (contents.querySelectorAll('a').length < studies) wrong.push('the contents leave studies out');
  scrollTo({top: 3000, behavior: 'instant'});
  const top = contents.getBoundingClientRect().top;
  if (Math.abs(top) > 1) wrong.push('the contents are out of sight: ' + top + ' px');
  scrollTo({top: 0, behavior: 'instant'});
  for (const figure of document.querySelectorAll('figure svg'))
    if (figure.getBoundingClientRect().right > innerWidth + 1) { wrong.push('a figure is cut'); break; }
  const large = document.getElementById('large');
  for (const one of [document.querySelector('img.opens'), document.querySelector('figure svg')]) {
    if (!one) continue;
    one.dispatchEvent(new MouseEvent('click', {bubbles: true}));
    if (!large.open || !large.querySelector('div > *')) wrong.push('a click on a picture does not open it');
    large.close();
    large.querySelector('div').replaceChildren();  // the page does it a moment later
  }
};
const checkCases = () => {
  const cases = [...document.querySelectorAll('details.case')];
  if (cases.length === 0) { wrong.push('no cases'); return; }
  location.hash = '#' + cases[0].id;
  dispatchEvent(new HashChangeEvent('hashchange'));
  if (!cases[0].open) wrong.push('a link to a case does not open it');
  document.getElementById('unfold').click();
  if (cases.some(one => !one.open)) wrong.push('not all cases open');
  const filter = document.getElementById('filter');
  filter.value = 'no claim contains this';
  filter.dispatchEvent(new Event('input'));
  if (cases.some(one => !one.hidden)) wrong.push('the filter shows what does not match');
  filter.value = '';
  filter.dispatchEvent(new Event('input'));
  if (cases.some(one => one.hidden)) wrong.push('an empty filter hides cases');
};
addEventListener('load', () => {
  for (const check of [checkLayout, checkTables, checkLinks, checkContents, checkCases, checkLayout]) try {
    check();
  } catch (e) {
    wrong.push(check.name + ': ' + e);
  }
  const found = wrong.length ? 'wrong: ' + wrong.slice(0, 5).join(' | ') : 'ok at ' + innerWidth + ' px';
  parent.postMessage(found, '*');
});
