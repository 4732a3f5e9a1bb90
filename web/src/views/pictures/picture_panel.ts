// Panels that show pictures of a run, or of all watched runs side by side.
import type { PictureStream, RunInstant } from '../../protocol/messages';
import { kNoRate, rateBadge } from '../../store/pictures/picture_rates';
import type { RateBadge } from '../../store/pictures/picture_rates';
import { refusalText } from '../../store/pictures/waiting_text';
import type { State, Topic } from '../../store/state';
import { runLetter } from '../../store/tracks';
import type { WatchedRun } from '../../store/watched_run';
import { h, setAttribute } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import type { Context, View } from '../view';
import type { PictureCell } from './picture_view';
import { PictureView } from './picture_view';

/** The picture of a run that a panel shows. */
export interface CellStream extends Pick<PictureCell, 'group' | 'asks' | 'legend' | 'empty'> {
  stream: Pick<PictureStream, 'name' | 'camera' | 'max_hz' | 'quality'>;
  /** Under which its pictures arrive. */
  key: string;
}

export abstract class PicturePanel implements View {
  readonly root: HTMLElement;
  protected readonly panel: Panel;
  protected readonly views = new Map<string, PictureView>();
  /** Frame of the main run's picture. */
  protected frame: number | null = null;
  private readonly grid = h('div', { class: 'picture-grid' });
  private readonly all: HTMLElement;

  constructor(
    protected readonly context: Context,
    private readonly name: string,
    private readonly title: string,
  ) {
    this.panel = makePanel(name, title);
    this.panel.body.append(this.grid);
    this.root = this.panel.root;
    this.all = h(
      'button',
      {
        class: 'tab',
        hidden: true,
        'data-role': 'side-by-side',
        title: 'Pictures of all runs, or only of the main one',
        onclick: () => context.session.setSideBySide(!context.store.state.sideBySide),
      },
      'All',
    );
    this.panel.tools.append(this.all);
    new ResizeObserver(() => this.arrange()).observe(this.grid);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('zoom')) {
      for (const view of this.views.values()) view.place();
      this.wish();
    }
    if (changed.has('hover')) for (const view of this.views.values()) view.showHover();
    const matters = ['pictures', 'playback', 'run', 'cameras'] as const;
    if (!matters.some((topic) => changed.has(topic))) return;
    const { state } = this.context.store;
    this.all.hidden = state.watched.length < 2;
    setAttribute(this.all, 'aria-pressed', String(state.sideBySide));
    this.fit(this.shownRuns(state));
    let any = false;
    for (const watched of this.shownRuns(state)) any = this.showRun(state, watched) || any;
    this.panel.showEmpty(any ? null : this.emptyText(state));
    this.wish();
  }

  onHidden(): void {
    for (const view of this.views.values()) view.leave();
    this.context.session.want(this.name, []);
  }

  /** The picture of a run; null if it has none of this kind. */
  protected abstract streamOf(watched: WatchedRun): CellStream | null;
  /** Shown if no run has such a picture. */
  protected abstract emptyText(state: State): string;

  private shownRuns(state: State): WatchedRun[] {
    if (state.sideBySide) return state.watched;
    return state.main === null ? [] : [state.main];
  }

  /** @return whether the run has a picture of this kind */
  private showRun(state: State, watched: WatchedRun): boolean {
    const cell = this.streamOf(watched);
    const view = this.views.get(watched.id);
    if (view === undefined) return false;
    view.root.hidden = cell === null;
    setAttribute(view.root, 'data-main', watched === state.main ? 'true' : null);
    const picture = cell === null ? null : (watched.pictures.get(cell.key) ?? null);
    const still = standingStill(state, watched);
    if (watched === state.main) {
      this.frame = picture?.frame ?? null;
      this.panel.showFrame(this.frame, still?.frame ?? null);
      this.panel.showRate(cell === null ? kNoRate : movingRate(state, watched, cell.key));
    }
    setAttribute(view.root, 'data-frame', picture === null ? null : String(picture.frame));
    if (cell === null) return false;
    const { group, asks, legend } = cell;
    const empty = refusalText(watched, cell.stream.name) ?? cell.empty;
    const title = runLetter(state, watched);
    view.show({ watched, picture, title, group, asks, legend, empty }, still?.t_ns ?? null);
    return true;
  }

  /** One view a run, in their order. */
  private fit(runs: readonly WatchedRun[]): void {
    const ids = runs.map(({ id }) => id);
    if (ids.join() === [...this.views.keys()].join()) return;
    const before = new Map(this.views);
    this.views.clear();
    for (const id of ids) {
      const known = before.get(id);
      this.views.set(id, known ?? new PictureView(this.context, this.title, () => this.wish()));
      before.delete(id);
    }
    for (const gone of before.values()) gone.leave();
    this.grid.replaceChildren(...[...this.views.values()].map(({ root }) => root));
    for (const [id, { root }] of this.views) setAttribute(root, 'data-run', id);
    this.arrange();
  }

  /** As many columns as make the pictures largest. */
  private arrange(): void {
    const { clientWidth: width, clientHeight: height } = this.grid;
    const count = Math.max(1, this.views.size);
    const aspect = 4 / 3;
    let best = { columns: 1, size: 0 };
    for (let columns = 1; columns <= count; columns++) {
      const rows = Math.ceil(count / columns);
      const size = Math.min(width / columns, (height / rows) * aspect);
      if (size > best.size) best = { columns, size };
    }
    this.grid.style.gridTemplateColumns = `repeat(${best.columns}, minmax(0, 1fr))`;
  }

  private wish(): void {
    const { state } = this.context.store;
    const streams = this.shownRuns(state).flatMap((watched): PictureStream[] => {
      const cell = this.streamOf(watched);
      const view = this.views.get(watched.id);
      if (cell === null || view === undefined || view.width_px === 0) return [];
      return [{ run: watched.id, ...cell.stream, max_width_px: view.width_px }];
    });
    this.context.session.want(this.name, streams);
  }
}

/** A run's instant while the playback is paused or stopped; null while it moves. */
export function standingStill({ clock }: State, watched: WatchedRun | null): RunInstant | null {
  return clock === null || clock.playing ? null : (watched?.instant ?? null);
}

/** The rate at which a stream's pictures arrive while they move. */
export function movingRate(state: State, watched: WatchedRun, key: string): RateBadge {
  if (state.clock?.playing !== true) return kNoRate;
  const measured = watched.meter.rate(key, performance.now());
  return rateBadge(measured, watched.rates.get(key), state.reduction);
}
