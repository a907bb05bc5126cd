// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The JSON of the server, as docs/http-api.md describes it.

export type Color = [number, number, number];
/** Null where the map knows no number. */
export type Point = [number | null, number | null, number | null];
export type CorrectionKind = 'rename' | 'merge' | 'split' | 'lock' | 'delete' | 'hide' | 'undo';

export interface MapInfo {
  title: string;
  program: string;
  version: number;
  mesh_version: number;
  /** The latest event that this knows of. */
  last_event: number;
  live: boolean;
  tracking: Tracking;
  frames: number;
  mask_frames: number;
  instances: number;
  voxel_size_m: number;
  up: Point;
  size_bytes: number;
  encoder: string;
  search: { state: 'preparing' | 'ready' | 'unavailable'; reason: string };
  classes: string | null;
  heat_ramp: Color[];
}

/** How the camera of a map that is being made is followed. */
export interface Tracking {
  /** given: its poses come from elsewhere. */
  state: 'given' | 'tracked' | 'lost';
  /** Since it was tracked last. */
  frames_lost: number;
  /** Closed when the map was completed. */
  loops: number;
  /** Where it was tracked last: three rows of the 4x4 matrix. */
  world_from_camera: number[];
}

export interface NameGuess {
  name: string;
  cosine: number;
}

/** A word for an object where one is clear, else "object". */
export interface ObjectLabel {
  name: string;
  share: number;
}

export interface Instance {
  id: number;
  name: string;
  /** Null until it is known. */
  label: ObjectLabel | null;
  guesses: NameGuess[];
  class: { id: number; name: string; color: Color } | null;
  color: Color;
  box: { min: Point; max: Point };
  centroid: Point;
  points: number;
  views: number;
  /** Null where the map does not know. */
  last_seen: { visit: number; visits: number; time_s: number | null } | null;
  /** How sure masks are that it is one whole thing; null where nobody rated them. */
  confidence: number | null;
  /** Nothing may change it before the lock is undone. */
  locked: boolean;
  crops: number[];
  /** What was read on it, surest first; empty in maps that nobody had read. */
  writing: WrittenLine[];
}

export interface WrittenLine {
  text: string;
  confidence: number;
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
  super_points: number[];
  neighbors: Neighbor[];
  parts: Part[];
}

/** A piece of an object that masks show by itself. */
export interface Part {
  number: number;
  box: Box;
  centroid: Point;
  points: number;
}

export interface ChunkListing {
  x: number;
  y: number;
  z: number;
  version: number;
  /** These three are null as long as the chunk was not made. */
  patches: number | null;
  vertices: number | null;
  triangles: number | null;
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

/** Event "frame": a frame went into the map, of all that did the last. */
export interface FrameEvent {
  frames: number;
  index: number;
  world_from_camera: number[];
}

/** Where a robot stands to see an object. Points are of the world. */
export interface ApproachPose {
  seen: number;
  distance_m: number;
  position: [number, number, number];
  direction: [number, number, number];
  way_m: number;
  way_in_world: [number, number, number][];
}

export interface Approach {
  poses: ApproachPose[];
  reason: string;
}

/** A part of the floor within walls and doors. Points are of the world, on the floor. */
export interface Room {
  id: number;
  name: string;
  area_m2: number;
  center: Point;
  /** Polygons: around it, then around what stands in it. */
  outline: Point[][];
  objects: number[];
}

export interface Rooms {
  rooms: Room[];
  doors: { rooms: [number, number]; place: Point; width_m: number }[];
}

/** Where somebody who scans should look next. */
export interface Gap {
  kind: 'unseen' | 'thin';
  middle: Point;
  box: Box;
  area_m2: number;
}

export interface Gaps {
  gaps: Gap[];
  /** False: nobody asked which space was seen. */
  space_known: boolean;
}

export interface Question {
  text?: string;
  not?: string[];
  like?: number;
}

export interface Box {
  min: Point;
  max: Point;
}

export interface Visit {
  visit: number;
  source: string;
  frames: number;
  /** Seconds since 1970 (UTC); null: nobody knows. */
  begin_s: number | null;
  end_s: number | null;
}

/** What a visit found about an object. */
export interface HistoryEvent {
  id: number;
  instance: number;
  name: string;
  /** What it clearly is; empty: not known. */
  label: string;
  event: 'appeared' | 'gone' | 'moved';
  visit: number;
  time_s: number | null;
  before: Box | null;
  after: Box | null;
  may_be: number | null;
  /** Whether the map keeps what it was before, and a picture of that. */
  surface: boolean;
  crop: boolean;
}

export interface History {
  version: number;
  visits: Visit[];
  events: HistoryEvent[];
}

/** Three numbers a point: metres in the world, and red, green, blue to 255. */
export interface PastSurface {
  instance: number;
  points: number[];
  colors: number[];
}

export interface Match {
  id: number;
  name: string;
  box: Box;
  centroid: Point;
  /** That ended what is shown; null: it is so now. */
  event: number | null;
  score: number;
  standard_score: number;
  p_value: number | null;
  probability: number | null;
  evidence: string;
  /** Of the object, where a part was asked for; null: all of it. */
  part: { number: number; box: Box } | null;
}

export interface Answer {
  query: string;
  verdict: 'found' | 'not_in_map';
  reading: string;
  reason: string;
  /** Of "how many" and "two ...". */
  count: { expected: number; deviation: number; found: number } | null;
  matches: Match[];
  heat: [number, number][];
}

/** To which object each label of the surface belongs. */
export interface Labels {
  version: number;
  /** By label; 0: none. */
  instances: number[];
  /** Objects whose surface is not drawn. */
  hidden: number[];
}

export interface Correction {
  kind: CorrectionKind;
  instance?: number;
  name?: string;
  into?: number;
  super_points?: number[];
  edit?: number;
}

/** A line of the log of corrections. */
export interface LoggedCorrection {
  id: number;
  kind: CorrectionKind;
  time_s: number;
  undone_by: number | null;
  instances?: number[];
  name?: string;
  new_instance?: number;
  undoes?: number;
}
