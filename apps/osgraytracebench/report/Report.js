// Report.js - sorts a table of the report's page by the heading that is clicked. Layer: apps.
// SPDX-License-Identifier: MIT
'use strict';

for (const table of document.querySelectorAll('table')) {
    const heads = [...table.tHead.rows[0].cells];
    const body = table.tBodies[0];

    const texts = (column) => [...body.rows].map((row) => row.cells[column].textContent.trim());
    const isMissing = (text) => text === '' || text === '\u2013';

    const sort = (column, ascending) => {
        const all = texts(column);
        const numeric = all.every((text) => isMissing(text) || !Number.isNaN(parseFloat(text)));
        const compare = numeric ? (a, b) => parseFloat(a) - parseFloat(b) : (a, b) => a.localeCompare(b);
        const rows = [...body.rows].map((row, index) => ({row, text: all[index]}));
        rows.sort((a, b) => {
            // Missing values are last in either order.
            if (isMissing(a.text) || isMissing(b.text)) return isMissing(a.text) - isMissing(b.text);
            return ascending ? compare(a.text, b.text) : compare(b.text, a.text);
        });
        body.append(...rows.map((entry) => entry.row));
    };

    heads.forEach((head, column) => {
        const button = document.createElement('button');
        button.type = 'button';
        button.title = 'Sort by this column';
        button.append(...head.childNodes);
        head.append(button);
        button.addEventListener('click', () => {
            const ascending = head.getAttribute('aria-sort') !== 'ascending';
            for (const other of heads) other.removeAttribute('aria-sort');
            head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
            sort(column, ascending);
        });
    });
}
