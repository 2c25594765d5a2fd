// Trees of bounding boxes for picking, made by a worker, so that the page stays responsive.
import { BufferAttribute, BufferGeometry, DoubleSide, InterleavedBuffer, InterleavedBufferAttribute } from 'three';
import { MeshBVH } from 'three-mesh-bvh';

const OPTIONS = { indirect: true, maxLeafTris: 10 }; // indirect: triangles keep their numbers, which name their parts

/** Answers the page's messages. Only in a worker. */
export function answerTreeRequests() {
  self.onmessage = ({ data: { number, positions, index } }) => {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new InterleavedBufferAttribute(new InterleavedBuffer(positions, 4), 3, 0));
    geometry.setIndex(new BufferAttribute(index, 1));
    const { roots, indirectBuffer } = MeshBVH.serialize(new MeshBVH(geometry, OPTIONS), { cloneBuffers: false });
    self.postMessage(
      { number, roots, indirectBuffer },
      [...roots, indirectBuffer.buffer].filter((buffer) => buffer instanceof ArrayBuffer),
    );
  };
}

/** Returns a promise of a tree for each mesh. Without a worker, this thread makes them when it has nothing to do. */
export async function treesOf(meshes, scriptText) {
  let worker = null;
  try {
    worker = new Worker(URL.createObjectURL(new Blob([scriptText], { type: 'text/javascript' })));
    return await Promise.all(meshes.map((mesh, number) => treeFromWorker(worker, mesh, number)));
  } catch {
    await new Promise((idle) => (window.requestIdleCallback ?? setTimeout)(idle));
    return meshes.map((mesh) => new MeshBVH(mesh.geometry, OPTIONS));
  } finally {
    worker?.terminate();
  }
}

function treeFromWorker(worker, mesh, number) {
  const { position } = mesh.geometry.attributes;
  return new Promise((resolve, reject) => {
    worker.addEventListener('error', reject);
    worker.addEventListener('message', ({ data }) => {
      if (data.number !== number) return;
      resolve(MeshBVH.deserialize({ ...data, index: null }, mesh.geometry, { setIndex: false }));
    });
    worker.postMessage({ number, positions: position.data.array, index: mesh.geometry.index.array });
  });
}

/** Returns {distance, triangle} of the first hit of a ray that is between two distances, or null. */
export function firstHit(mesh, tree, ray, near, far) {
  const inverse = mesh.matrixWorld.clone().invert();
  const local = ray.clone().applyMatrix4(inverse);
  // Meshes are scaled by the same factor in all directions, so distances are, too.
  const hit = tree.raycastFirst(local, DoubleSide, near / mesh.scale.x, far / mesh.scale.x);
  return hit ? { distance: hit.distance * mesh.scale.x, triangle: hit.faceIndex } : null;
}
