// A layer of the raster as values: its poses, what is known of each, and the pose that is nearest to a place.

export const NO_GROUND = -2147483648;
const NO_QUANTITY = 65535;
const LARGEST_COLUMN_TABLE = 1 << 24;
const FARTHEST_RING = 12;

/** Returns value(), computed at the first call only. */
function lazily(compute) {
  let value;
  let known = false;
  return () => {
    if (!known) {
      value = compute();
      known = true;
    }
    return value;
  };
}

/** Returns a layer of a pack. Arrays that are only needed for answers are decoded at the first answer. */
export function readLayer(pack, json) {
  const { grid, z0, z_unit: unit } = json;
  const cell = pack.array(json.cell);
  const z = pack.array(json.z);
  const ground = pack.array(json.ground);
  const verdict = pack.array(json.verdict);
  const optional = (description) => lazily(() => (description ? pack.array(description) : null));
  const layer = {
    name: json.name,
    stance: json.stance,
    yaw: json.yaw,
    counts: json.counts,
    count: json.count,
    grid,
    z0,
    unit,
    cell,
    z,
    ground,
    verdict,
    hit: optional(json.hit),
    roll: optional(json.roll),
    pitch: optional(json.pitch),
    island: optional(json.island),
    hasIslands: Boolean(json.island),
    quantities: (json.quantities ?? []).map((quantity) => ({ ...quantity, values: optional(quantity.values) })),
  };
  if (json.roll && !layer.quantities.some(({ name }) => name === 'tilt')) layer.quantities.push(tiltQuantity(layer));
  layer.reasonOf = reasonReader(pack, json);
  layer.columnStarts = lazily(() => columnStarts(layer));
  return layer;
}

// The tilt follows from roll and pitch, so packs need not have it.
function tiltQuantity(layer) {
  const scale = Math.PI / (NO_QUANTITY - 1);
  const values = lazily(() => {
    const [roll, pitch] = [layer.roll(), layer.pitch()];
    const angle = Math.PI / 32767;
    return Uint16Array.from(roll, (value, pose) =>
      Math.round(Math.acos(Math.cos(value * angle) * Math.cos(pitch[pose] * angle)) / scale),
    );
  });
  return { name: 'tilt', unit: 'rad', scale, offset: 0, values };
}

function reasonReader(pack, json) {
  if (!json.reason) return () => '';
  const reasons = json.reasons;
  const numbersIn = reasons.map((text) => text.split('\u0001').length - 1);
  const index = lazily(() => pack.array(json.reason));
  const firstNumber = lazily(() => {
    const first = new Uint32Array(json.count + 1);
    for (let pose = 0; pose < json.count; ++pose) first[pose + 1] = first[pose] + numbersIn[index()[pose]];
    return first;
  });
  const lines = lazily(() => {
    const text = json.reason_numbers ? pack.text(json.reason_numbers) : '';
    const starts = [0];
    for (let at = text.indexOf('\n'); at >= 0; at = text.indexOf('\n', at + 1)) starts.push(at + 1);
    return { text, starts };
  });
  return (pose) => {
    const template = reasons[index()[pose]] ?? '';
    const { text, starts } = lines();
    let next = firstNumber()[pose];
    return template.replace(/\u0001/g, () => {
      const line = next++;
      return text.slice(starts[line], starts[line + 1] - 1);
    });
  };
}

/** Returns for each column the first pose of it, and the number of poses behind the last, or null for huge grids. */
function columnStarts({ grid, cell, count }) {
  const columns = grid.cols * grid.rows;
  if (columns > LARGEST_COLUMN_TABLE) return null;
  const starts = new Uint32Array(columns + 1);
  for (let pose = 0, column = 0; column <= columns; ++column) {
    while (pose < count && cell[pose] < column) ++pose;
    starts[column] = pose;
  }
  return starts;
}

function firstPoseOf(layer, column) {
  const starts = layer.columnStarts();
  if (starts) return starts[column];
  let low = 0;
  let high = layer.count;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (layer.cell[middle] < column) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Returns the height in the scene at which a pose is drawn: that of its ground, else that of its origin. */
export function drawnHeight(layer, pose) {
  const value = layer.ground[pose] === NO_GROUND ? layer.z[pose] : layer.ground[pose];
  return layer.z0 + layer.unit * value;
}

/** Returns the stored heights at which poses are drawn, in units of the layer. */
export function drawnValues(layer) {
  const heights = layer.ground.slice();
  for (let pose = 0; pose < layer.count; ++pose) if (heights[pose] === NO_GROUND) heights[pose] = layer.z[pose];
  return heights;
}

/** Returns {x, y, z, roll, pitch, yaw} of a pose in double precision, as `spawnfield check` reads it. */
export function poseNumbers(layer, pose) {
  const { grid } = layer;
  const angle = (values) => (values() ? (values()[pose] * Math.PI) / 32767 : 0);
  return {
    x: grid.x0 + (layer.cell[pose] % grid.cols) * grid.step,
    y: grid.y0 + Math.floor(layer.cell[pose] / grid.cols) * grid.step,
    z: layer.z0 + layer.unit * layer.z[pose],
    roll: angle(layer.roll),
    pitch: angle(layer.pitch),
    yaw: layer.yaw,
  };
}

/** Returns the value of a quantity at a pose, or null. */
export function quantityAt(quantity, pose) {
  const value = quantity.values()[pose];
  return value === NO_QUANTITY ? null : quantity.offset + quantity.scale * value;
}

/** Returns [smallest, largest] value of a quantity of a layer, or null if no pose has one. */
export function quantityRange(quantity) {
  let [low, high] = [NO_QUANTITY, -1];
  for (const value of quantity.values()) {
    if (value === NO_QUANTITY) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return high < 0 ? null : [quantity.offset + quantity.scale * low, quantity.offset + quantity.scale * high];
}

/**
 * Returns the pose that is nearest to a place of the scene, or -1: of the poses in the place's column that one whose
 * ground is nearest in height, else the nearest of the columns around it. Poses drawn above `highest` do not count.
 */
export function nearestPose(layer, x, y, z, highest = Infinity) {
  const { grid } = layer;
  const col = Math.round((x - grid.x0) / grid.step);
  const row = Math.round((y - grid.y0) / grid.step);
  for (let ring = 0; ring <= FARTHEST_RING; ++ring) {
    let nearest = -1;
    let least = Infinity;
    for (const [c, r] of ringAround(col, row, ring)) {
      if (c < 0 || r < 0 || c >= grid.cols || r >= grid.rows) continue;
      const column = r * grid.cols + c;
      const aside = Math.hypot(grid.x0 + c * grid.step - x, grid.y0 + r * grid.step - y);
      for (let pose = firstPoseOf(layer, column); pose < layer.count && layer.cell[pose] === column; ++pose) {
        const height = drawnHeight(layer, pose);
        if (height > highest) continue;
        const distance = Math.abs(height - z) + (ring === 0 ? 0 : aside);
        if (distance < least) {
          least = distance;
          nearest = pose;
        }
      }
    }
    if (nearest >= 0) return nearest;
  }
  return -1;
}

function* ringAround(col, row, ring) {
  for (let r = row - ring; r <= row + ring; ++r) {
    const wholeRow = Math.abs(r - row) === ring;
    for (let c = col - ring; c <= col + ring; c += wholeRow || ring === 0 ? 1 : 2 * ring) yield [c, r];
  }
}

/**
 * Returns for each pose the slope of the ground in x and y from the neighbouring poses, as two bytes: 128 + 64 · slope.
 * With it, the squares of the layer lie on the ground. `heights` are drawnValues(layer). Slopes beyond ±2 count as steps,
 * not as slopes.
 */
export function groundSlopes(layer, heights) {
  const { grid, cell, count } = layer;
  const { cols, step } = grid;
  const slopes = new Uint8Array(2 * count).fill(128);
  const starts = layer.columnStarts();
  if (!starts) return slopes;
  const reach = (2 * step) / layer.unit;
  const rise = (pose, column) => {
    // of the neighbour nearest in height, NaN without one
    let least = NaN;
    for (let other = starts[column]; other < starts[column + 1]; ++other) {
      const difference = heights[other] - heights[pose];
      if (!(Math.abs(difference) >= Math.abs(least))) least = difference;
    }
    return Math.abs(least) <= reach ? least : NaN;
  };
  const along = (before, after) => {
    if (before !== before) return after === after ? after : 0;
    return after === after ? (after - before) / 2 : -before;
  };
  const perUnit = (64 * layer.unit) / step;
  for (let pose = 0; pose < count; ++pose) {
    const column = cell[pose];
    const c = column % cols;
    const dx = along(c > 0 ? rise(pose, column - 1) : NaN, c + 1 < cols ? rise(pose, column + 1) : NaN);
    const dy = along(
      column >= cols ? rise(pose, column - cols) : NaN,
      column + cols < starts.length - 1 ? rise(pose, column + cols) : NaN,
    );
    slopes[2 * pose] = 128 + Math.max(-127, Math.min(127, Math.round(dx * perUnit)));
    slopes[2 * pose + 1] = 128 + Math.max(-127, Math.min(127, Math.round(dy * perUnit)));
  }
  return slopes;
}
