'use strict';
// Tables sort by a click on a column's head: first upwards, then downwards; numbers by their value, words by the alphabet.
const keyOf = (row, column) => {
  const cell = row.cells[column];
  return cell.dataset.key !== undefined ? Number(cell.dataset.key) : cell.textContent.trim();
};
const before = (a, b) => {
  const numbers = typeof a === 'number' && typeof b === 'number';
  if (numbers) return a - b;
  if (typeof a === 'number') return -1;  // what has no number comes last
  if (typeof b === 'number') return 1;
  return a.localeCompare(b, 'en', {numeric: true});
};
for (const head of document.querySelectorAll('table.sortable th button')) {
  head.addEventListener('click', () => {
    const th = head.parentElement, body = th.closest('table').tBodies[0];
    const down = th.getAttribute('aria-sort') === 'ascending';
    for (const other of th.parentElement.children) if (other.hasAttribute('aria-sort')) other.setAttribute('aria-sort', 'none');
    th.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const rows = [...body.rows].map((row, i) => [keyOf(row, th.cellIndex), i, row]);
    rows.sort((a, b) => (down ? before(b[0], a[0]) : before(a[0], b[0])) || a[1] - b[1]);
    for (const [, , row] of rows) body.append(row);
  });
}
// On a narrow screen the contents lie above the text: closed until they are asked for, and again when a place is chosen.
const list = document.querySelector('.contents details'), wide = matchMedia('(min-width:1200px)');
if (list) {
  const fit = () => { list.open = wide.matches; };
  wide.addEventListener('change', fit);
  list.addEventListener('click', event => { if (event.target.tagName === 'A') fit(); });
  fit();
}
// A picture or a figure opens large, on a click or on Enter.
const large = document.getElementById('large');
const enlarge = event => {
  const one = event.target.closest('.opens,figure svg');
  if (!one || !large || large.contains(one) || (event.type === 'keydown' && event.key !== 'Enter')) return;
  large.querySelector('div').replaceChildren(one.cloneNode(true));
  large.showModal();
};
addEventListener('click', enlarge);
addEventListener('keydown', enlarge);
if (large) large.addEventListener('click', event => { if (event.target === large) large.close(); });
if (large) large.addEventListener('close', () => large.querySelector('div').replaceChildren());
// A link to a case opens it.
const openTarget = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (target && target.tagName === 'DETAILS') target.open = true, target.scrollIntoView();
};
addEventListener('hashchange', openTarget);
openTarget();
const cases = [...document.querySelectorAll('details.case')];
const filter = document.getElementById('filter'), unfold = document.getElementById('unfold');
if (filter) filter.addEventListener('input', () => {
  const wanted = filter.value.trim().toLowerCase();
  for (const one of cases) {
    let any = false;
    for (const row of one.querySelectorAll('tbody tr')) {
      row.hidden = wanted !== '' && !row.textContent.toLowerCase().includes(wanted) && !one.id.includes(wanted);
      any = any || !row.hidden;
    }
    one.hidden = !any;
    if (wanted !== '') one.open = any;
  }
});
if (unfold) unfold.addEventListener('click', () => {
  const open = cases.some(one => !one.open);
  for (const one of cases) one.open = open;
  unfold.textContent = open ? 'Close all cases' : 'Open all cases';
});
