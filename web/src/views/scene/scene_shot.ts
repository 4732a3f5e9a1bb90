// Saves the 3D view as a picture file: drawn again in its largest size, with labels and attribution.
import { picturesOf } from '../../connection/stream_client';
import { formatTime } from '../../store/format';
import { placeLabels } from '../../store/scene/scene_labels';
import type { State } from '../../store/state';
import type { Picture, WatchedRun } from '../../store/watched_run';
import { download } from '../download';
import { h } from '../dom';
import { paint } from '../paint';
import type { Context } from '../view';
import { labelText } from './label_layer';
import { sceneWish } from './scene_wish';

const kView = 'shot';
const kKey = picturesOf('scene', undefined, kView);
const kQuality = 97;
const kLargest_px = { width: 1920, height: 1440 };
const kPatience_ms = 15_000;

/** @param shown  size of the view on the screen, for its shape */
export async function shootScene(
  context: Context,
  shown: { width: number; height: number },
): Promise<void> {
  const { client, notices, scene, session, store } = context;
  const [wish] = sceneWish(store.state);
  const watched = wish === undefined ? undefined : store.state.watchedRun(wish.run);
  if (wish === undefined || watched === undefined) return;
  if (shown.width === 0 || shown.height === 0) return;
  const scale = Math.min(kLargest_px.width / shown.width, kLargest_px.height / shown.height);
  const even = (value: number) => Math.max(64, 2 * Math.floor((value * scale) / 2));
  const size = { width_px: even(shown.width), height_px: even(shown.height) };
  // A picture of an earlier view, which came too late.
  forget(watched);
  client.command({ type: 'view', view: kView, ...scene.view(), ...size });
  session.want(kView, [{ ...wish, view: kView, quality: kQuality, max_hz: 5, encoding: 'jpeg' }]);
  try {
    const picture = await nextPicture(context, watched, size.width_px);
    const name = `overfly-3d-${wish.run}-${picture.frame}.png`;
    download(name, await composed(store.state, watched, picture));
  } catch (error) {
    notices.error(`The view cannot be saved: ${error instanceof Error ? error.message : ''}`);
  } finally {
    session.want(kView, []);
    forget(watched);
  }
}

function forget({ pictures }: WatchedRun): void {
  pictures.get(kKey)?.bitmap.close();
  pictures.delete(kKey);
}

/** The first picture of the wanted width; while the playback stands still, of its instant. */
function nextPicture({ store }: Context, watched: WatchedRun, width_px: number): Promise<Picture> {
  const end_ms = performance.now() + kPatience_ms;
  return new Promise((resolve, reject) => {
    const look = () => {
      const { clock } = store.state;
      const picture = watched.pictures.get(kKey);
      const still = clock !== null && !clock.playing ? watched.instant?.frame : undefined;
      const right = picture?.width_px === width_px && (still ?? picture.frame) === picture.frame;
      if (picture !== undefined && right) resolve(picture);
      else if (performance.now() > end_ms) reject(new Error('the server did not draw it in time'));
      else requestAnimationFrame(look);
    };
    look();
  });
}

async function composed(state: State, { run }: WatchedRun, picture: Picture): Promise<Blob> {
  const canvas = h('canvas', { width: picture.width_px, height: picture.height_px });
  const context = canvas.getContext('2d');
  if (context === null) throw new Error('the browser cannot draw');
  context.drawImage(picture.bitmap, 0, 0);
  const unit = Math.max(10, Math.round(picture.width_px / 80));
  drawLabels(context, state, picture, unit);
  const time = formatTime(picture.t_ns);
  pill(context, `${run?.title ?? ''} · ${time} · frame ${picture.frame}`, unit, 'left');
  pill(context, ['Overfly', run?.attribution].filter(Boolean).join(' · '), unit, 'right');
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => {
      if (blob === null) reject(new Error('the picture is too large'));
      else resolve(blob);
    }, 'image/png');
  });
}

/** Text in a lower corner. */
function pill(
  context: CanvasRenderingContext2D,
  text: string,
  unit: number,
  side: 'left' | 'right',
): void {
  const { width, height } = context.canvas;
  context.font = `${unit}px sans-serif`;
  const wide = context.measureText(text).width + unit;
  const left = side === 'left' ? unit / 2 : width - wide - unit / 2;
  context.fillStyle = paint('var(--over)');
  context.fillRect(left, height - 2.1 * unit, wide, 1.6 * unit);
  context.fillStyle = paint('var(--over-text)');
  context.fillText(text, left + unit / 2, height - unit);
}

function drawLabels(
  context: CanvasRenderingContext2D,
  state: State,
  picture: Picture,
  unit: number,
): void {
  context.font = `${unit}px sans-serif`;
  const entries = picture.labels.flatMap((label) => {
    const text = labelText(state, label);
    if (text === null) return [];
    const width = context.measureText(text.text).width + unit;
    return [{ ...text, x: label.x_px, y: label.y_px, width, height: 1.6 * unit }];
  });
  const area = { width: picture.width_px, height: picture.height_px };
  placeLabels(entries, area).forEach(({ left, top }, i) => {
    const entry = entries[i];
    if (entry === undefined) return;
    context.strokeStyle = paint(entry.colour);
    context.lineWidth = Math.max(1, unit / 10);
    context.beginPath();
    context.moveTo(left + entry.width / 2, top + entry.height);
    context.lineTo(entry.x, entry.y);
    context.stroke();
    context.fillStyle = paint('var(--over)');
    context.fillRect(left, top, entry.width, entry.height);
    context.fillStyle = paint(entry.colour);
    context.fillRect(left, top, unit / 4, entry.height);
    context.fillStyle = paint('var(--over-text)');
    context.fillText(entry.text, left + unit / 2, top + 1.15 * unit);
  });
}
