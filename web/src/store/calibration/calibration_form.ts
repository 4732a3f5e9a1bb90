// The choices of the calibration page: source, board, lens; and what the server is asked for.
import type {
  BoardRequest,
  LensRequest,
  SessionRequest,
  SourceRequest,
} from '../../protocol/calibration_types';
import type { JsonObject } from '../../protocol/rest_types';

export const kSourceKinds = ['scenario', 'folder', 'upload', 'recording', 'camera'] as const;
export type SourceKind = (typeof kSourceKinds)[number];

export const kBoards = ['checkerboard', '4x4', '5x5', '6x6'] as const;

export interface CalibrationForm {
  kind: SourceKind;
  /** By kind: the name of the folder, recording, scenario or camera. */
  names: Record<SourceKind, string>;
  topic: string;
  camera: string;
  views: string;
  board: (typeof kBoards)[number];
  cols: string;
  rows: string;
  square_mm: string;
  marker_mm: string;
  acceptSymmetric: boolean;
  model: string;
  k3: boolean;
}

export function initialForm(): CalibrationForm {
  return {
    kind: 'scenario',
    names: { scenario: '', folder: '', upload: '', recording: '', camera: '' },
    topic: '',
    camera: '',
    views: '20',
    board: 'checkerboard',
    cols: '9',
    rows: '6',
    square_mm: '30',
    marker_mm: '20',
    acceptSymmetric: false,
    model: 'radtan',
    k3: false,
  };
}

/** A result, or what is wrong with the form. */
export type Checked<T> = { value: T } | { error: string };

/**
 * Why a board is ambiguous: half a turn moves square (i, j) to (cols - i, rows - j), whose colour is
 * the same exactly if cols + rows is even. null if it is not, or has markers.
 */
export function ambiguityOf(form: CalibrationForm): string | null {
  const [cols, rows] = [Number(form.cols), Number(form.rows)];
  const whole = Number.isInteger(cols) && Number.isInteger(rows);
  if (form.board !== 'checkerboard' || !whole || (cols + rows) % 2 !== 0) return null;
  const both = cols % 2 === 0 ? 'even' : 'odd';
  return (
    `${cols} x ${rows} looks the same after half a turn, because both numbers are ${both}: an image ` +
    `does not say which corner is the first. Use a board with one odd and one even number, ` +
    `such as ${cols} x ${rows === 60 ? rows - 1 : rows + 1}.`
  );
}

export function lensOf(form: CalibrationForm): LensRequest {
  return { model: form.model, k3: form.model === 'radtan' && form.k3 };
}

export function requestOf(form: CalibrationForm): Checked<SessionRequest> {
  const source = sourceOf(form);
  if ('error' in source) return source;
  const board = boardOf(form);
  if ('error' in board) return board;
  const ambiguity = ambiguityOf(form);
  if (ambiguity !== null && !form.acceptSymmetric) return { error: ambiguity };
  return {
    value: {
      source: source.value,
      board: board.value,
      accept_symmetric: form.acceptSymmetric,
      ...lensOf(form),
    },
  };
}

function sourceOf(form: CalibrationForm): Checked<SourceRequest> {
  const { kind } = form;
  if (kind === 'upload') return { value: { kind } };
  const name = form.names[kind];
  if (name === '') return { error: `Choose a ${kind}.` };
  if (kind === 'recording') {
    const topic = form.topic.trim();
    return { value: topic === '' ? { kind, name } : { kind, name, topic } };
  }
  if (kind === 'scenario') {
    const views = Number(form.views);
    if (!Number.isInteger(views) || views < 4 || views > 200) {
      return { error: 'Views: must be a whole number in [4, 200].' };
    }
    return { value: { kind, name, camera: form.camera, views } };
  }
  return { value: { kind, name } };
}

function boardOf(form: CalibrationForm): Checked<BoardRequest> {
  const cols = Number(form.cols);
  const rows = Number(form.rows);
  for (const [label, count] of [
    ['Columns', cols],
    ['Rows', rows],
  ] as const) {
    if (!Number.isInteger(count) || count < 3 || count > 60) {
      return { error: `${label}: must be a whole number of inner corners in [3, 60].` };
    }
  }
  const square_m = Number(form.square_mm) / 1000;
  if (!(square_m > 0 && square_m <= 10)) {
    return { error: 'Square: must be a length in (0, 10000] mm.' };
  }
  if (form.board === 'checkerboard') return { value: { cols, rows, square_m } };
  const marker_m = Number(form.marker_mm) / 1000;
  if (!(marker_m >= 0.3 * square_m && marker_m <= 0.9 * square_m)) {
    return { error: 'Marker: must be 0.3 to 0.9 of the square.' };
  }
  return { value: { cols, rows, square_m, markers: form.board, marker_m } };
}

/** Names of a scenario's cameras, the main one first. */
export function camerasOf(document: JsonObject): string[] {
  const several = document['cameras'];
  const cameras = Array.isArray(several) ? several : [document['camera'] ?? {}];
  return cameras.map((camera) => {
    const name =
      typeof camera === 'object' && camera !== null && !Array.isArray(camera)
        ? camera['name']
        : undefined;
    return typeof name === 'string' ? name : 'camera0';
  });
}
