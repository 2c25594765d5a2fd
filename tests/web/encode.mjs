// Writes packs (docs/review-format.md), for tests.
import { MeshoptEncoder, zlibSync } from './libraries.mjs';

await MeshoptEncoder.ready;

const TYPES = new Map([
  [Uint8Array, 'u8'],
  [Uint16Array, 'u16'],
  [Uint32Array, 'u32'],
  [Int16Array, 'i16'],
  [Int32Array, 'i32'],
  [Float32Array, 'f32'],
]);
const bytesOf = (values) => new Uint8Array(values.buffer, values.byteOffset, values.byteLength);

/** Returns {array(values, coding, width), text(text), bytes(json)}: arrays give their descriptions for the JSON. */
export function createPack() {
  const blocks = [];
  let at = 0;
  function block(content, description) {
    const packed = zlibSync(content, { level: 6 });
    blocks.push(packed);
    at += packed.length;
    return { ...description, at: at - packed.length, bytes: packed.length };
  }
  return {
    array(values, coding = 'delta', width = 1) {
      const count = values.length / width;
      return block(encoded(values, coding, count), { type: TYPES.get(values.constructor), count, width, coding });
    },
    text(text) {
      const content = new TextEncoder().encode(text);
      return block(content, { type: 'text', count: content.length, width: 1, coding: 'plain' });
    },
    bytes(json) {
      const text = new TextEncoder().encode(JSON.stringify(json));
      const head = Buffer.alloc(12);
      head.write('SPAWNRV1');
      head.writeUInt32LE(text.length, 8);
      return Buffer.concat([head, text, ...blocks]);
    },
  };
}

function encoded(values, coding, count) {
  if (coding === 'plain') return bytesOf(values);
  if (coding === 'vertex') return MeshoptEncoder.encodeVertexBuffer(bytesOf(values), count, values.byteLength / count);
  if (coding === 'index') return MeshoptEncoder.encodeIndexBuffer(bytesOf(values), count, 4);
  return deltaPlanes(values);
}

function deltaPlanes(values) {
  const size = values.BYTES_PER_ELEMENT;
  const bits = 8 * size;
  const planes = new Uint8Array(values.length * size);
  let last = 0;
  for (let i = 0; i < values.length; ++i) {
    const difference = ((values[i] - last) << (32 - bits)) >> (32 - bits); // in the same number of bits
    const code = (difference << 1) ^ (difference >> 31);
    for (let plane = 0; plane < size; ++plane) planes[plane * values.length + i] = code >>> (8 * plane);
    last = values[i];
  }
  return planes;
}
