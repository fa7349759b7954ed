// Places for names on the field, so that none covers another.

const covers = (one, other) =>
  one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

// Return the lower edge of a name that is to be here: moved up, above the names that were placed before.
export function placeLabel(placed, x, y, width, height) {
  const box = { left: x - width / 2, right: x + width / 2, top: y - height, bottom: y };
  for (let hidden = placed.find((each) => covers(each, box)); hidden; hidden = placed.find((each) => covers(each, box))) {
    box.bottom = hidden.top;
    box.top = box.bottom - height;
  }
  placed.push(box);
  return box.bottom;
}
