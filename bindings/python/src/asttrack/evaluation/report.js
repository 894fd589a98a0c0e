"use strict";
(() => {
    /* A click on a column's head sorts by it: the better end first, then the other way round. */
    const value = (row, column) => {
        const cell = row.cells[column];
        return cell.dataset.value === undefined ? cell.textContent.trim() : cell.dataset.value === "" ? NaN : Number(cell.dataset.value);
    };
    const compare = (a, b) => {
        if (typeof a === "string") return a.localeCompare(b, undefined, { numeric: true });
        if (Number.isNaN(a) || Number.isNaN(b)) return 0;
        return a - b;
    };
    const sort = (head) => {
        const table = head.closest("table");
        const first = head.dataset.better === "1" ? "descending" : "ascending";
        const other = first === "ascending" ? "descending" : "ascending";
        const direction = head.getAttribute("aria-sort") === first ? other : first;
        for (const one of table.tHead.rows[0].cells) one.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", direction);
        const sign = direction === "ascending" ? 1 : -1;
        const column = head.cellIndex;
        const rows = [...table.tBodies[0].rows];
        /* What has no value stays at the end in both directions. */
        const missing = rows.filter((row) => Number.isNaN(value(row, column)));
        const known = rows.filter((row) => !missing.includes(row));
        known.sort((a, b) => sign * compare(value(a, column), value(b, column)));
        table.tBodies[0].append(...known, ...missing);
    };
    for (const button of document.querySelectorAll("th button")) {
        button.addEventListener("click", () => sort(button.closest("th")));
    }

    /* A click on a tracker hides it in the charts and pictures. */
    for (const button of document.querySelectorAll(".legend button")) {
        button.addEventListener("click", () => {
            const shown = button.getAttribute("aria-pressed") === "true";
            button.setAttribute("aria-pressed", String(!shown));
            document.documentElement.classList.toggle("off-" + button.dataset.tracker, shown);
        });
    }
})();
