// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type Camera, type Mesh, Raycaster, Vector2, type Vector3, type Vector4 } from 'three';
import type { Surface } from './surface';

export interface Pick {
  point: Vector3;
  /** 0: surface that belongs to no object. */
  instance: number;
  /** The map's label there; 0: none. */
  label: number;
}

/** What of the surface is seen at a place of the canvas, in [-1, 1] with y up. */
export function pick(surface: Surface, camera: Camera, at: Vector2): Pick | null {
  const ray = new Raycaster();
  ray.setFromCamera(at, camera);
  const section = surface.material.uniforms.section!.value as Vector4;
  const visible = surface.group.children.filter((child) => child.visible);
  for (const hit of ray.intersectObjects<Mesh>(visible, false)) {
    const { point, face } = hit;
    if (!face || section.x * point.x + section.y * point.y + section.z * point.z + section.w > 0)
      continue;
    // The shader takes a label from a triangle's last corner, too.
    const label = hit.object.geometry.getAttribute('label').getX(face.c);
    if (!surface.table.isHidden(label))
      return { point, label, instance: surface.table.instanceOf(label) };
  }
  return null;
}
