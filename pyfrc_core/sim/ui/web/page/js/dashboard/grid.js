// Places on a dashboard's grid: { x, y, w, h } in columns and rows. Nothing here knows the page, and nothing is changed in place.

function overlap(one, other) {
  return one.x < other.x + other.w && other.x < one.x + one.w && one.y < other.y + other.h && other.y < one.y + one.h;
}

// Whether a place is on the grid, and no widget but the one with this index is there.
export function isFree({ columns, rows, widgets }, place, index = -1) {
  const isInside = place.x >= 0 && place.y >= 0 && place.w >= 1 && place.h >= 1 && place.x + place.w <= columns && place.y + place.h <= rows;
  return isInside && !widgets.some((each, other) => other !== index && overlap(each, place));
}

// The first free place of a size, or of a smaller one; null if the grid is full.
export function firstFree(grid, { w, h }) {
  for (let [wide, high] = [Math.min(w, grid.columns), Math.min(h, grid.rows)]; ; ) {
    for (let y = 0; y + high <= grid.rows; y++) {
      for (let x = 0; x + wide <= grid.columns; x++) if (isFree(grid, { x, y, w: wide, h: high })) return { x, y, w: wide, h: high };
    }
    if (wide === 1 && high === 1) return null;
    [wide, high] = [Math.ceil(wide / 2), Math.ceil(high / 2)];
  }
}

// A place of a size at a cell, or as near to it as there is space; null if the grid is full.
export function nearestFree(grid, size, { x, y }) {
  const distance = (place) => Math.hypot(place.x - x, place.y - y);
  let best = null;
  for (let top = 0; top + size.h <= grid.rows; top++) {
    for (let left = 0; left + size.w <= grid.columns; left++) {
      const place = { x: left, y: top, w: size.w, h: size.h };
      if (isFree(grid, place) && (!best || distance(place) < distance(best))) best = place;
    }
  }
  return best ?? firstFree(grid, size);
}

// The next free place of a widget in a direction, beyond others that are in its way; null if there is none.
export function movedBy(grid, index, [right, down]) {
  const { x, y, w, h } = grid.widgets[index];
  for (let step = 1; step <= Math.max(grid.columns, grid.rows); step++) {
    const place = { x: x + right * step, y: y + down * step, w, h };
    if (isFree(grid, place, index)) return place;
  }
  return null;
}

// A dashboard whose widgets are all on its grid, such as one that was made smaller, or that Git has merged.
export function fitted(dashboard) {
  const { columns, rows } = dashboard;
  const widgets = dashboard.widgets.map((widget) => {
    const [w, h] = [Math.min(widget.w, columns), Math.min(widget.h, rows)];
    return { ...widget, w, h, x: Math.min(widget.x, columns - w), y: Math.min(widget.y, rows - h) };
  });
  return { ...dashboard, widgets };
}
