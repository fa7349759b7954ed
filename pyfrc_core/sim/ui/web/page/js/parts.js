// The elements of lists, which are values of their own named `path[0]`. Parts of structs are values anyway.

const LONGEST_LIST = 64; // elements that are offered
const ELEMENT = /^(.+)\[(\d+)\]$/;

// The paths of a list's elements; none of other values.
export function elementsOf(path, value) {
  return Array.isArray(value) ? value.slice(0, LONGEST_LIST).map((_, index) => `${path}[${index}]`) : [];
}

// The list and the index that a path may name: [path, index].
export function elementIn(path) {
  const match = ELEMENT.exec(path);
  return match ? [match[1], Number(match[2])] : [path, null];
}

// The value of a path, which may name an element of a list.
export function valueIn(values, path) {
  if (values.has(path)) return values.get(path);
  const [list, index] = elementIn(path);
  const value = index === null ? undefined : values.get(list);
  return Array.isArray(value) ? value[index] : undefined;
}
