// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type {
  Answer,
  Approach,
  Cameras,
  ChunkListing,
  Correction,
  Gaps,
  History,
  Instance,
  InstanceDetail,
  Labels,
  LoggedCorrection,
  MapInfo,
  MeshListing,
  PastSurface,
  Question,
  Rooms,
} from './types';

/** A request that failed, said in a sentence that a person can act on. */
export class ApiError extends Error {
  constructor(
    message: string,
    readonly status: number,
  ) {
    super(message);
  }
}

const UNREACHABLE =
  'The server does not answer. Is `ovimap serve` still running? Start it again and reload this page.';

async function checked(response: Response): Promise<Response> {
  if (response.ok) return response;
  const body: unknown = await response.json().catch(() => null);
  const said =
    typeof body === 'object' && body !== null && 'error' in body ? String(body.error) : '';
  throw new ApiError(said || `The server answered with error ${response.status}.`, response.status);
}

async function request(path: string, options?: RequestInit): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error instanceof DOMException && error.name === 'AbortError') throw error;
    throw new ApiError(UNREACHABLE, 0);
  }
  return checked(response);
}

async function get<T>(path: string): Promise<T> {
  return (await request(path)).json() as Promise<T>;
}

async function post<T>(path: string, body: unknown, signal?: AbortSignal): Promise<T> {
  const response = await request(path, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify(body),
    signal: signal ?? null,
  });
  return response.json() as Promise<T>;
}

export const api = {
  map: () => get<MapInfo>('/api/map'),
  instances: async () => (await get<{ instances: Instance[] }>('/api/instances')).instances,
  instance: (id: number) => get<InstanceDetail>(`/api/instances/${id}`),
  cropUrl: (id: number, ordinal: number) => `/api/instances/${id}/crops/${ordinal}`,
  /** What is newer than version `since`. */
  chunks: (level: number, since = 0) => get<MeshListing>(`/api/mesh?level=${level}&since=${since}`),
  chunk: async (level: number, at: ChunkListing, since: number) =>
    (await request(`/api/mesh/${level}/${at.x}/${at.y}/${at.z}?since=${since}`)).arrayBuffer(),
  labels: () => get<Labels>('/api/labels'),
  cameras: () => get<Cameras>('/api/cameras'),
  gaps: () => get<Gaps>('/api/gaps'),
  rooms: () => get<Rooms>('/api/rooms'),
  history: () => get<History>('/api/history'),
  /** What the object of an event was before it. */
  pastSurface: (event: number) => get<PastSurface>(`/api/history/${event}/surface`),
  pastCropUrl: (event: number) => `/api/history/${event}/crop`,
  query: (question: Question, signal?: AbortSignal) =>
    post<Answer>('/api/query', { ...question, heat: true }, signal),
  /** `from`: a point of the world where the robot is; without it there is no way. */
  approach: (instance: number, from: number[] | null) =>
    post<Approach>('/api/approach', from ? { instance, from } : { instance }),
  correct: (correction: Correction) =>
    post<{ version: number; edit: number }>('/api/corrections', correction),
  corrections: async () =>
    (await get<{ corrections: LoggedCorrection[] }>('/api/corrections')).corrections,
  glb: async () => (await request('/api/export.glb')).blob(),
};
