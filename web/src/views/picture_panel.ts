// Panels that show the pictures of a stream; here the debug images of the estimators.
import type { RunInstant } from '../protocol/messages';
import { rateText } from '../store/picture_rates';
import type { State, Topic } from '../store/state';
import { h, rebuild } from './dom';
import type { Panel } from './panel';
import { makePanel } from './panel';
import { PictureCanvas } from './picture_canvas';
import type { Context, View } from './view';

export abstract class PicturePanel implements View {
  readonly root: HTMLElement;
  protected readonly panel: Panel;
  private readonly picture: PictureCanvas;
  /** Frame of the picture shown. */
  protected frame: number | null = null;

  constructor(
    protected readonly context: Context,
    name: string,
    title: string,
  ) {
    this.panel = makePanel(name, title);
    this.picture = new PictureCanvas(title);
    this.panel.body.append(this.picture.canvas);
    this.root = this.panel.root;
  }

  update(changed: ReadonlySet<Topic>): void {
    const matters = ['pictures', 'playback', 'run', 'cameras'] as const;
    if (!matters.some((topic) => changed.has(topic))) return;
    const { state } = this.context.store;
    const stream = this.streamOf(state);
    const picture = stream === null ? null : (state.pictures.get(stream) ?? null);
    this.picture.show(picture);
    this.frame = picture?.frame ?? null;
    const still = standingStill(state);
    this.picture.markStale(still?.t_ns ?? null);
    this.panel.showFrame(picture?.frame ?? null, still?.frame ?? null);
    this.panel.showEmpty(picture === null ? this.emptyText(state) : null);
    this.panel.showRate(rateText(stream === null ? undefined : state.rates.get(stream)));
  }

  protected abstract streamOf(state: State): string | null;
  protected abstract emptyText(state: State): string;
}

/** The debug image of one of the estimators. */
export class DebugPanel extends PicturePanel {
  private readonly chooser = h('select', { id: 'debug-of', 'aria-label': 'Estimator' });
  private selected: string | null = null;

  constructor(context: Context) {
    super(context, 'debug', 'Estimator');
    this.panel.tools.append(this.chooser);
    this.chooser.addEventListener('change', () => {
      this.selected = this.chooser.value;
      context.store.change('pictures');
    });
  }

  override update(changed: ReadonlySet<Topic>): void {
    if (changed.has('run')) this.updateChooser();
    super.update(changed);
  }

  protected override streamOf(state: State): string | null {
    const name = this.current(state);
    return name === null ? null : `debug/${name}`;
  }

  protected override emptyText(state: State): string {
    if (state.run !== null && state.run.estimators.length === 0) {
      return 'This flight has no estimators.';
    }
    const recorded = state.run !== null && state.playback !== null && !state.playback.live;
    return recorded ? 'No debug image at this instant.' : waitingText(state);
  }

  private current(state: State): string | null {
    const names = state.run?.estimators ?? [];
    return this.selected !== null && names.includes(this.selected)
      ? this.selected
      : (names[0] ?? null);
  }

  private updateChooser(): void {
    const { state } = this.context.store;
    const names = state.run?.estimators ?? [];
    rebuild(this.chooser, JSON.stringify(names), () =>
      names.map((name) => h('option', { value: name }, name)),
    );
    this.chooser.hidden = names.length === 0;
    this.chooser.value = this.current(state) ?? '';
  }
}

/** The main run's instant while the playback is paused or stopped; null while it moves. */
export function standingStill({ main, clock }: State): RunInstant | null {
  return clock === null || clock.playing ? null : (main?.instant ?? null);
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

export function waitingText(state: State): string {
  if (state.runId === null) return 'Choose a run, or launch one.';
  if (state.run?.status === 'queued') return 'The run is queued.';
  if (state.run?.status === 'failed') return 'The run failed.';
  // The first flight over a world has to make the world.
  if (state.run !== null && state.run.notice !== null) return sentence(state.run.notice);
  return 'Waiting for the first picture';
}
