// Answers as values: what the pack knows of a pose of a layer, or of a pose of a list.
import { drawnHeight, NO_GROUND, poseNumbers, quantityAt } from './layer_data.js';
import { row } from './csv.js';
import { withUnit } from './numbers.js';

export const CSV_COLUMNS = ['x', 'y', 'z', 'roll', 'pitch', 'yaw', 'verdict', 'ground', 'hit'];

const VOXEL = { name: 'a voxel of the OctoMap', label: 'voxel', part: null };

/** Returns {name, label, part} of what a robot hits, or null. */
export function hitOf(json, hit) {
  if (!hit) return null;
  const part = json.parts[hit - 1];
  return part ? { name: part.name, label: part.label, part: hit - 1 } : VOXEL;
}

/** Returns the answer for a pose of a layer. */
export function layerAnswer(json, layer, pose) {
  const numbers = poseNumbers(layer, pose);
  const ground = layer.ground[pose] === NO_GROUND ? null : layer.z0 + layer.unit * layer.ground[pose];
  const island = layer.island()?.[pose] ?? 0;
  const verdict = layer.verdict[pose];
  const quantities = layer.quantities.map((quantity) => ({
    name: quantity.name,
    unit: quantity.unit,
    value: quantityAt(quantity, pose),
  }));
  return {
    kind: 'layer',
    pose: [numbers.x, numbers.y, numbers.z, numbers.roll, numbers.pitch, numbers.yaw],
    verdict,
    verdictName: json.verdicts[verdict]?.name ?? '',
    words: json.verdicts[verdict]?.words ?? '',
    reason: layer.reasonOf(pose),
    hit: hitOf(json, layer.hit()?.[pose] ?? 0),
    ground,
    quantities,
    island: island > 0 ? island - 1 : null,
    islandKnown: layer.hasIslands,
    drawnHeight: drawnHeight(layer, pose),
    source: `pose ${pose + 1} of ${layer.count} of layer ${layer.name}`,
    name: '',
    fields: null,
    contacts: [],
  };
}

/** Returns the answer for a pose of a list of spawns. */
export function spawnAnswer(json, list, index) {
  const verdict = list.verdicts[index];
  const at = (values) => values?.[index] ?? null;
  return {
    kind: 'spawn',
    pose: list.poses[index],
    verdict,
    verdictName: json.verdicts[verdict]?.name ?? '',
    words: json.verdicts[verdict]?.words ?? '',
    reason: list.reasons?.[index] ?? '',
    hit: hitOf(json, list.hits?.[index] ?? 0),
    ground: null,
    quantities: [
      { name: 'tilt', unit: 'rad', value: at(list.tilt) },
      { name: 'margin', unit: 'm', value: at(list.margin) },
      { name: 'clearance', unit: 'm', value: at(list.clearance) },
    ],
    island: null,
    islandKnown: false,
    drawnHeight: list.poses[index][2],
    source: `row ${index + 2} of ${list.file}`,
    name: spawnName(list, index),
    fields: list.columns?.map((column, c) => [column, list.rows?.[index]?.[c] ?? '']) ?? null,
    contacts: list.contacts?.[index] ?? [],
  };
}

/** Returns words if the ground of an answer is far above or below the place that was clicked, else ''. */
export function farFromClick(answer, clickedHeight, step) {
  const above = clickedHeight - answer.drawnHeight;
  if (Math.abs(above) <= Math.max(0.5, step)) return '';
  const distance = withUnit(Math.abs(above), 'm');
  return `The place that you clicked is ${distance} ${above > 0 ? 'above' : 'below'} the nearest ground, which is judged here.`;
}

/** Returns the name of a pose of a list: its column "name", else its number. */
export function spawnName(list, index) {
  const column = list.columns?.indexOf('name') ?? -1;
  return (column >= 0 && list.rows?.[index]?.[column]) || `pose ${index + 1}`;
}

/** Returns a reason without the name of the verdict, with which it begins. */
export function withoutVerdict(reason, verdict) {
  if (reason === verdict) return '';
  return reason.startsWith(`${verdict}: `) ? reason.slice(verdict.length + 2) : reason;
}

/** Returns an answer as a row of CSV with CSV_COLUMNS. */
export function answerRow({ pose, verdictName, ground, hit }) {
  return row([...pose, verdictName, ground, hit?.name ?? '']);
}
