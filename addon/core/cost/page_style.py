# SPDX-License-Identifier: GPL-3.0-or-later
"""The style of the page, light or dark as the reader's system is, and what sorts its table."""

STYLE = """
:root { color-scheme: light dark; --ink: #1d2026; --soft: #5d6470; --grid: #dfe2e8;
  --page: #f6f7f9; --card: #ffffff; --accent: #0072b2; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8eaee; --soft: #9aa2af; --grid: #343942;
  --page: #15171b; --card: #1e2127; --accent: #56b4e9; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 32px 24px 64px; background: var(--page);
  color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 12px; overflow-wrap: anywhere; }
h2 { font-size: 18px; margin: 0 0 12px; }
h3 { font-size: 15px; margin: 0 0 8px; }
.brand { margin: 0; color: var(--accent); font-weight: 600; letter-spacing: .04em; }
.sentence { font-size: 17px; margin: 0; padding: 12px 16px; border-left: 4px solid var(--accent);
  background: var(--card); border-radius: 0 8px 8px 0; }
section, header { margin: 0 0 28px; }
.plot, .scroll { background: var(--card); border-radius: 10px; padding: 12px; margin: 0;
  overflow-x: auto; }
svg { display: block; width: 100%; height: auto; font: 12px system-ui, sans-serif; }
.hint, figcaption, dt { color: var(--soft); font-size: 13px; }
.hint { margin: 8px 0 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 10px; text-align: right; white-space: nowrap;
  border-bottom: 1px solid var(--grid); }
th:first-child { text-align: left; font-weight: 500; }
tbody tr:last-child > * { border-bottom: 0; }
tbody tr:hover { background: var(--page); }
thead button { all: unset; cursor: pointer; font-weight: 600; font-size: 13px;
  color: var(--soft); }
thead button:hover, thead button:focus-visible { color: var(--accent); }
i { display: inline-block; width: 11px; height: 11px; border-radius: 3px; margin-right: 8px; }
.cards { display: grid; gap: 16px; }
article { background: var(--card); border-radius: 10px; padding: 14px 16px; min-width: 0; }
.reference img { max-width: 640px; }
.two { display: grid; grid-template-columns: repeat(2, 1fr); gap: 10px; }
figure { margin: 0; min-width: 0; }
img { display: block; width: 100%; height: auto; border-radius: 4px; image-rendering: auto; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 4px 16px; margin: 0; }
dd { margin: 0; overflow-wrap: anywhere; }
@media (max-width: 640px) { .two { grid-template-columns: 1fr; } }
"""

SCRIPT = """
for (const [column, button] of document.querySelectorAll('thead button').entries()) {
  let up = true;
  button.addEventListener('click', () => {
    const body = document.querySelector('tbody');
    const value = row => {
      const cell = row.children[column];
      if (column === 0) return cell.textContent;
      return cell.dataset.sort === '' ? Infinity : Number(cell.dataset.sort);
    };
    const rows = [...body.rows].sort((a, b) => {
      const x = value(a), y = value(b);
      return (x > y ? 1 : x < y ? -1 : 0) * (up ? 1 : -1);
    });
    up = !up;
    body.append(...rows);
  });
}
"""
