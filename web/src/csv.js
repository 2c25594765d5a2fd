// CSV (RFC 4180). Numbers are the shortest text that reads back to the same double.

/** Returns a field of a CSV file. Line ends become spaces, because rows of spawnfield have one line each. */
export function field(value) {
  const text = value === null || value === undefined ? '' : String(value).replace(/[\r\n\u2028\u2029]+/g, ' ');
  return /[",]/.test(text) || text !== text.trim() ? `"${text.replace(/"/g, '""')}"` : text;
}

export const row = (values) => values.map(field).join(',');

/** Returns the text of a CSV file. */
export function csv(columns, rows) {
  return [columns, ...rows].map((values) => `${row(values)}\n`).join('');
}
