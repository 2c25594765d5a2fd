// Reads packs: docs/review-format.md describes them.
import { unzlibSync } from 'fflate';
import { MeshoptDecoder } from 'meshoptimizer/meshopt_decoder.module.js';

const MAGIC = 'SPAWNRV1';
const FORMAT = 'spawnfield-review/1';
const HEAD_BYTES = 12;
const MOST_VALUES = 1 << 28; // of an array; a gigabyte
const ARRAY_TYPES = {
  u8: Uint8Array,
  u16: Uint16Array,
  u32: Uint32Array,
  i16: Int16Array,
  i32: Int32Array,
  f32: Float32Array,
};

/** A pack that cannot be read. The message says what is wrong and what to do. */
export class PackError extends Error {}

const advice = 'The file is damaged or incomplete. Write it again with "spawnfield review", or copy it again.';

/**
 * Returns the bytes that a text in base64 stands for. Throws PackError if the text is not base64.
 */
export function bytesFromBase64(text) {
  let binary;
  try {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text); // several times faster; browsers since 2025
    binary = atob(text.trim());
  } catch {
    throw new PackError(`The data of the page is not base64. ${advice}`);
  }
  const bytes = new Uint8Array(binary.length);
  for (let at = 0; at < binary.length; ++at) bytes[at] = binary.charCodeAt(at);
  return bytes;
}

/**
 * Returns {json, array, text} of a pack: its JSON, a function that decodes an array, and one that decodes a text.
 * Arrays are decoded when they are asked for, each time again. Throws PackError if the pack is damaged.
 */
export async function readPack(bytes) {
  await MeshoptDecoder.ready;
  const json = readJson(bytes);
  const blocks = bytes.subarray(HEAD_BYTES + jsonLength(bytes));
  return {
    json,
    array: (description) => decodeArray(blocks, description),
    text: (description) => new TextDecoder().decode(inflate(blocks, description, description.count)),
  };
}

function jsonLength(bytes) {
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength).getUint32(8, true);
}

function readJson(bytes) {
  const magic = String.fromCharCode(...bytes.subarray(0, MAGIC.length));
  if (bytes.length < HEAD_BYTES || magic !== MAGIC)
    throw new PackError(`The data of the page does not begin with ${MAGIC}. ${advice}`);
  const end = HEAD_BYTES + jsonLength(bytes);
  if (end > bytes.length) throw new PackError(`The data of the page ends within its description. ${advice}`);
  let json;
  try {
    json = JSON.parse(new TextDecoder().decode(bytes.subarray(HEAD_BYTES, end)));
  } catch {
    throw new PackError(`The description of the page's data is not JSON. ${advice}`);
  }
  if (json === null || typeof json !== 'object')
    throw new PackError(`The description of the page's data is not a JSON object. ${advice}`);
  if (json.format !== undefined && json.format !== FORMAT)
    throw new PackError(`The data has the format ${json.format}; this page reads ${FORMAT}. Write the page again.`);
  return json;
}

function inflate(blocks, description, expectedBytes) {
  const { at, bytes } = description;
  if (!(at >= 0 && bytes > 0 && at + bytes <= blocks.length))
    throw new PackError(
      `The data of the page ends at byte ${blocks.length} of its blocks; a block goes on to ` +
        `${at + bytes}. ${advice}`,
    );
  const block = blocks.subarray(at, at + bytes);
  let content;
  try {
    content = unzlibSync(block, expectedBytes === undefined ? {} : { out: new Uint8Array(expectedBytes) });
  } catch (error) {
    throw new PackError(`A block of the data at byte ${at} cannot be unpacked (${error.message}). ${advice}`);
  }
  if (expectedBytes !== undefined && content.length !== expectedBytes)
    throw new PackError(
      `A block of the data at byte ${at} has ${content.length} bytes, needs ${expectedBytes}. ` + advice,
    );
  if (adler32(content) !== new DataView(block.buffer, block.byteOffset + bytes - 4, 4).getUint32(0))
    throw new PackError(`A block of the data at byte ${at} has a wrong checksum. ${advice}`);
  return content;
}

// The checksum at the end of a zlib stream, which fflate does not compare.
function adler32(bytes) {
  let low = 1;
  let high = 0;
  for (let at = 0; at < bytes.length; ) {
    const end = Math.min(at + 3800, bytes.length);
    for (; at < end; ++at) {
      low += bytes[at];
      high += low;
    }
    low %= 65521;
    high %= 65521;
  }
  return ((high << 16) | low) >>> 0;
}

function decodeArray(blocks, description) {
  const { type, count, coding, width = 1 } = description;
  const Type = ARRAY_TYPES[type];
  if (!Type || !(Number.isInteger(count) && count >= 0 && width >= 1 && count * width <= MOST_VALUES))
    throw new PackError(`An array of the data has the type "${type}" and ${count} items. ${advice}`);
  const length = count * width;
  switch (coding) {
    case 'plain':
      return new Type(inflate(blocks, description, length * Type.BYTES_PER_ELEMENT).buffer);
    case 'delta':
      return decodeDelta(inflate(blocks, description, length * Type.BYTES_PER_ELEMENT), Type, length);
    case 'vertex':
      return decodeMesh(inflate(blocks, description), new Type(length), count, 'decodeVertexBuffer');
    case 'index':
      return decodeMesh(inflate(blocks, description), new Type(length), count, 'decodeIndexBuffer');
    default:
      throw new PackError(`An array of the data has the unknown coding "${coding}". Write the page again.`);
  }
}

function decodeMesh(block, target, count, decode) {
  const itemBytes = decode === 'decodeIndexBuffer' ? 4 : target.byteLength / Math.max(count, 1);
  try {
    MeshoptDecoder[decode](new Uint8Array(target.buffer), count, itemBytes, block);
  } catch (error) {
    throw new PackError(`A mesh of the data cannot be decoded (${error.message}). ${advice}`);
  }
  return target;
}

// One loop for each size, because a general loop over bytes is several times slower.
function decodeDelta(planes, Type, length) {
  const values = new Type(length);
  let last = 0;
  if (Type.BYTES_PER_ELEMENT === 1) {
    for (let i = 0; i < length; ++i) {
      const code = planes[i];
      values[i] = last = last + ((code >>> 1) ^ -(code & 1));
    }
  } else if (Type.BYTES_PER_ELEMENT === 2) {
    for (let i = 0; i < length; ++i) {
      const code = planes[i] | (planes[length + i] << 8);
      values[i] = last = (last + ((code >>> 1) ^ -(code & 1))) | 0;
    }
  } else {
    const [second, third, fourth] = [length, 2 * length, 3 * length];
    for (let i = 0; i < length; ++i) {
      const code = planes[i] | (planes[second + i] << 8) | (planes[third + i] << 16) | (planes[fourth + i] << 24);
      values[i] = last = (last + ((code >>> 1) ^ -(code & 1))) | 0;
    }
  }
  return values;
}
