// Colours and patterns. They are told apart by colour-blind people, and the patterns in greyscale, too.

const VIRIDIS = [
  '#440154',
  '#482878',
  '#3e4a89',
  '#31688e',
  '#26828e',
  '#1f9e89',
  '#35b779',
  '#6ece58',
  '#b5de2b',
  '#fde725',
];
export const ISLAND_COLORS = ['#332288', '#ddcc77', '#44aa99', '#cc6677', '#88ccee', '#aa4499', '#9a9a9a'];
export const NO_ISLAND_COLOR = '#4a4a4a';
export const NO_VALUE_COLOR = '#8a8a8a';
export const PATTERN_SIZE = 8;

// Each pattern is a tile of 8 by 8 pixels: one byte for each row, ink where a bit is set.
const PATTERNS = [
  [0x81, 0x42, 0x24, 0x18, 0x18, 0x24, 0x42, 0x81], // crosses
  [0x03, 0x06, 0x0c, 0x18, 0x30, 0x60, 0xc0, 0x81], // stripes, rising
  [0x00, 0x00, 0x18, 0x3c, 0x3c, 0x18, 0x00, 0x00], // dots
  [0xff, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00], // horizontal lines
  [0xc0, 0xc0, 0xc0, 0xc0, 0xc0, 0xc0, 0xc0, 0xc0], // vertical lines
  [0xc0, 0x60, 0x30, 0x18, 0x0c, 0x06, 0x03, 0x81], // stripes, falling
  [0xff, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80], // grid
  [0xf0, 0xf0, 0xf0, 0xf0, 0x0f, 0x0f, 0x0f, 0x0f], // checks
  [0x88, 0x00, 0x22, 0x00, 0x88, 0x00, 0x22, 0x00], // fine dots
  [0x18, 0x24, 0x42, 0x81, 0x00, 0x00, 0x00, 0x00], // zigzag
];
const PLAIN = [0, 0, 0, 0, 0, 0, 0, 0];

/** Returns [red, green, blue], each 0 to 1, of "#rrggbb"; grey for another text. */
export function rgb(color) {
  const digits = /^#([0-9a-f]{6})$/i.exec(color)?.[1];
  if (!digits) return [0.5, 0.5, 0.5];
  const number = parseInt(digits, 16);
  return [number >> 16, (number >> 8) & 255, number & 255].map((value) => value / 255);
}

/** Returns "#rrggbb" of a colour that may come from a file; grey for all that is not of this form. */
export function safeColor(color) {
  return /^#[0-9a-f]{6}$/i.test(color) ? color : '#808080';
}

/** Returns whether a colour is so light that dark ink is seen better on it than white ink. */
export function isLight(color) {
  const [red, green, blue] = rgb(color);
  return 0.299 * red + 0.587 * green + 0.114 * blue > 0.5;
}

/** Returns the colour of viridis at 0 to 1 as [red, green, blue]. */
export function viridis(share) {
  const at = Math.max(0, Math.min(1, share)) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const [low, high] = [rgb(VIRIDIS[below]), rgb(VIRIDIS[below + 1])];
  return low.map((value, channel) => value + (at - below) * (high[channel] - value));
}

/** Returns the rows of bits of each verdict's pattern: "valid" is plain, the others have one each. */
export function verdictPatterns(verdicts) {
  let next = 0;
  return verdicts.map(({ name }) => (name === 'valid' ? PLAIN : PATTERNS[next++ % PATTERNS.length]));
}

/** Returns one byte for each pixel of the tiles of all patterns, one tile below the other: 255 for ink. */
export function patternPixels(patterns) {
  const pixels = new Uint8Array(patterns.length * PATTERN_SIZE * PATTERN_SIZE);
  patterns.flat().forEach((bits, row) => {
    for (let col = 0; col < PATTERN_SIZE; ++col) if (bits & (0x80 >> col)) pixels[row * PATTERN_SIZE + col] = 255;
  });
  return pixels;
}

/** Draws a swatch of a colour with a pattern (or null) on a canvas. */
export function drawSwatch(canvas, color, pattern) {
  const context = canvas.getContext('2d');
  context.fillStyle = safeColor(color);
  context.fillRect(0, 0, canvas.width, canvas.height);
  if (!pattern) return;
  context.fillStyle = isLight(color) ? '#000000' : '#ffffff';
  for (let y = 0; y < canvas.height; ++y)
    for (let x = 0; x < canvas.width; ++x)
      if (pattern[y % PATTERN_SIZE] & (0x80 >> x % PATTERN_SIZE)) context.fillRect(x, y, 1, 1);
}
