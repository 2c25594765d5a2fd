// Numbers as the page shows them.

/** Returns a number with at most `digits` digits behind the point, without zeros at its end. */
export function rounded(value, digits = 3) {
  return Number(value.toFixed(digits)).toString();
}

/** Returns a value with its unit, for people: angles in degrees, lengths in m. "none" for null. */
export function withUnit(value, unit) {
  if (value === null || value === undefined || Number.isNaN(value)) return 'none';
  if (unit === 'rad') return `${rounded((value * 180) / Math.PI, 1)}°`;
  return unit ? `${rounded(value)} ${unit}` : rounded(value);
}

/** Returns a count with spaces between the thousands. */
export function grouped(count) {
  return String(count).replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f');
}

/** Returns a whole number or a share with its percent sign, for example "12 %" or "less than 1 %". */
export function percent(share) {
  const value = share * 100;
  if (value > 0 && value < 1) return 'less than 1 %';
  return `${value > 99 && value < 100 ? 99 : Math.round(value)} %`;
}

/** Returns 1, 2 or 5 times a power of ten: the largest that is not above the value. */
export function niceBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((factor) => factor * power).find((nice) => nice <= value * (1 + 1e-9)) ?? power;
}
