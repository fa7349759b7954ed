// The tables that robot code has published, each with its type, such as "Field2d".

const TYPE = "/.type";

// All of them: [path, type].
export function typedTables(values) {
  const found = [];
  for (const [path, type] of values) {
    if (path.startsWith("nt:") && path.endsWith(TYPE) && typeof type === "string") found.push([path.slice(0, -TYPE.length), type]);
  }
  return found;
}

// The paths of those of a type.
export function tablesOf(values, type) {
  return typedTables(values).filter((each) => each[1] === type).map(([path]) => path);
}
