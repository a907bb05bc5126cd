// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The JSON of the server, as docs/http-api.md describes it.

export type Color = [number, number, number];
/** Null where the map knows no number. */
export type Point = [number | null, number | null, number | null];
export type CorrectionKind = 'rename' | 'merge' | 'hide' | 'lock' | 'delete';

export interface MapInfo {
  title: string;
  program: string;
  version: number;
  mesh_version: number;
  live: boolean;
  frames: number;
  mask_frames: number;
  instances: number;
  voxel_size_m: number;
  up: Point;
  size_bytes: number;
  encoder: string;
  search: { state: 'preparing' | 'ready' | 'unavailable'; reason: string };
  classes: string | null;
  corrections: CorrectionKind[];
  heat_ramp: Color[];
}

export interface NameGuess {
  name: string;
  cosine: number;
}

export interface Instance {
  id: number;
  name: string;
  guesses: NameGuess[];
  class: { id: number; name: string; color: Color } | null;
  color: Color;
  box: { min: Point; max: Point };
  centroid: Point;
  points: number;
  views: number;
  crops: number[];
}

export interface Neighbor {
  id: number;
  relation: string;
  gap_m: number;
  evidence: string;
}

export interface InstanceDetail extends Instance {
  height_m: number;
  footprint_m2: number;
  neighbors: Neighbor[];
}

export interface ChunkListing {
  x: number;
  y: number;
  z: number;
  version: number;
  patches: number;
  vertices: number;
  triangles: number;
}

export interface MeshListing {
  version: number;
  level: number;
  chunk_edge_m: number;
  chunks: ChunkListing[];
}

export interface Cameras {
  camera: { width: number; height: number; fx: number; fy: number; cx: number; cy: number };
  frames: { index: number; timestamp_s: number; labelled: boolean; world_from_camera: number[] }[];
}

export interface Question {
  text?: string;
  not?: string[];
  like?: number;
}

export interface Match {
  id: number;
  name: string;
  score: number;
  standard_score: number;
  p_value: number | null;
  probability: number | null;
  evidence: string;
}

export interface Answer {
  query: string;
  verdict: 'found' | 'not_in_map';
  reading: string;
  reason: string;
  matches: Match[];
  heat: [number, number][];
}

export interface Correction {
  kind: CorrectionKind;
  instance: number;
  name?: string;
  into?: number;
  on?: boolean;
}
