// The top bar: the run, its status, and the connection to the server.
import type { State, Topic } from '../store/state';
import {
  reportedVoidShare,
  texelsPerPixel,
  textureHint,
  textureLimited,
} from '../store/errors/error_table';
import { formatNumber, formatPercent } from '../store/format';
import { h, setAttribute, setText } from './dom';
import { icon } from './icons';
import { LayoutMenu } from './frame/layout_menu';
import { Menu } from './menu';
import { ReportButton } from './runs/report_button';
import { ThemeMenu } from './theme_menu';
import type { Context, View } from './view';

export class HeaderBar implements View {
  readonly root: HTMLElement;
  private readonly title = h('span', { class: 'run-title' });
  private readonly status = h('span', { class: 'chip', 'data-role': 'status' });
  private readonly flag = h('span', {
    class: 'chip warn',
    'data-role': 'texture-limited',
    hidden: true,
  });
  private readonly withoutImagery = h('span', {
    class: 'chip warn',
    'data-role': 'without-imagery',
    hidden: true,
  });
  private readonly changed = h('span', {
    class: 'chip warn',
    'data-role': 'world-change',
    hidden: true,
  });
  private readonly error = h('span', { class: 'run-error' });
  private readonly attribution = h('span', { class: 'attribution' });
  private readonly connection = h('button', {
    class: 'chip connection',
    'data-role': 'connection',
  });
  private readonly report: ReportButton;
  private readonly layouts: LayoutMenu;
  private readonly themes: ThemeMenu;
  private countdown = 0;

  constructor(private readonly context: Context) {
    this.report = new ReportButton(context);
    this.layouts = new LayoutMenu(context);
    this.themes = new ThemeMenu(context);
    this.connection.addEventListener('click', () => {
      if (context.store.state.connection.status === 'locked') location.reload();
      else context.client.connect();
    });
    const help = h(
      'button',
      {
        class: 'icon-button help-button',
        title: 'Keyboard shortcuts (?)',
        'aria-label': 'Keyboard shortcuts',
        onclick: () => {
          context.store.state.helpOpen = true;
          context.store.change('help');
        },
      },
      '?',
    );
    const commands = h(
      'button',
      {
        class: 'icon-button',
        title: 'Every command by name (Ctrl K)',
        'aria-label': 'Commands',
        'data-role': 'open-palette',
        onclick: () => {
          // In the next frame, once the click has taken the focus from the button: it would get it back.
          context.store.state.paletteOpen = true;
          context.store.change('palette');
        },
      },
      icon('search'),
    );
    this.root = h(
      'header',
      { class: 'header-bar' },
      h('h1', {}, 'Overfly'),
      this.title,
      this.status,
      this.flag,
      this.withoutImagery,
      this.changed,
      this.report.root,
      this.error,
      h('span', { class: 'spacer' }),
      this.attribution,
      pagesMenu(context),
      this.layouts.root,
      this.themes.root,
      viewOnlyChip(),
      this.connection,
      commands,
      help,
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    this.report.update(changed);
    this.layouts.update(changed);
    this.themes.update(changed);
    if (changed.has('run') || changed.has('metrics')) this.updateRun(state);
    if (changed.has('connection')) this.updateConnection(state);
  }

  private updateRun(state: State): void {
    const { run } = state;
    setText(this.title, run?.title ?? (state.runId === null ? 'No run chosen' : state.runId));
    this.title.title = run === null ? '' : `${run.id} · scenario ${run.scenario} · ${run.pacing}`;
    const share = run === null || run.frames_total === 0 ? 0 : run.frames / run.frames_total;
    const running = run?.status === 'running' ? ` ${formatPercent(share, 0)}` : '';
    const deleted = state.main?.deleted === true;
    setText(this.status, run === null ? '' : deleted ? 'deleted' : `${run.status}${running}`);
    setAttribute(this.status, 'data-status', deleted ? 'deleted' : (run?.status ?? null));
    setText(this.error, run?.error ?? '');
    this.error.title = run?.error ?? '';
    setText(this.attribution, run?.attribution ?? '');
    this.attribution.title = run?.attribution ?? '';
    const worldChange = run?.world_change ?? null;
    this.changed.hidden = worldChange === null;
    setText(this.changed, 'Ground has changed');
    this.changed.title = worldChange ?? '';
    const median = texelsPerPixel(state.metrics);
    this.flag.hidden = !textureLimited(run, state.metrics);
    const figure = median === null ? '' : `: ${formatNumber(median, 2)} texels/px`;
    setText(this.flag, `Texture-limited${figure}`);
    this.flag.title = textureHint(median);
    const voidShare = reportedVoidShare(state.metrics);
    this.withoutImagery.hidden = voidShare === null;
    setText(this.withoutImagery, `Without imagery: ${formatPercent(voidShare, 0)} of the frames`);
    this.withoutImagery.title =
      'More than half of the image is without imagery in these frames: estimators have little to ' +
      'see there. Fly over the imagery, or give the world more of it.';
    document.title = run === null ? 'Overfly' : `${run.title} · Overfly`;
  }

  private updateConnection(state: State): void {
    const { connection } = state;
    clearInterval(this.countdown);
    setAttribute(this.connection, 'data-status', connection.status);
    this.connection.title = connection.status === 'open' ? connection.server : '';
    const useful = connection.status === 'waiting' || connection.status === 'locked';
    this.connection.toggleAttribute('disabled', !useful);
    switch (connection.status) {
      case 'open': {
        setText(this.connection, 'Connected');
        return;
      }
      case 'connecting': {
        setText(this.connection, connection.attempt > 1 ? 'Reconnecting' : 'Connecting');
        return;
      }
      case 'incompatible':
        this.connection.title = connection.reason;
        {
          setText(this.connection, 'Reload the page');
          return;
        }
      case 'locked': {
        this.connection.title =
          'The server no longer accepts the token of this browser: the server was restarted, or the cookie ' +
          'is gone. Click to reload the page and enter the token that the server printed.';
        setText(this.connection, 'Session over · click to enter the token');
        return;
      }
      case 'waiting':
        this.connection.title = `${connection.reason ?? 'Connection lost'}. Click to try again now.`;
        {
          const what = connection.reason === undefined ? 'Connection lost' : 'Rejected';
          this.countDown(what, connection.delay_ms);
          return;
        }
    }
  }

  private countDown(what: string, delay_ms: number): void {
    const due_ms = performance.now() + delay_ms;
    const show = () => {
      const left_s = Math.max(0, Math.ceil((due_ms - performance.now()) / 1000));
      setText(this.connection, `${what} · retry in ${left_s} s`);
    };
    show();
    this.countdown = window.setInterval(show, 500);
  }
}

function viewOnlyChip(): HTMLElement {
  return h(
    'span',
    {
      class: 'chip view-only',
      'data-role': 'view-only',
      'data-viewer-only': true,
      tabindex: 0,
      title:
        "This page was opened with the viewer's address: everything can be looked at, played, compared " +
        "and saved on this computer. Starting and changing flights need the operator's address.",
    },
    'View only',
  );
}

/** On a wide screen its sheet is a row of the bar, and it has no opener (layout.css, narrow.css). */
function pagesMenu(context: Context): HTMLElement {
  const opener = h(
    'button',
    {
      class: 'menu-opener',
      type: 'button',
      title: 'Pages',
      'aria-label': 'Pages',
      'data-role': 'pages-menu',
    },
    icon('menu'),
  );
  const pages = h(
    'nav',
    { class: 'page-buttons', id: 'pages', 'aria-label': 'Pages' },
    ...pageButtons(context),
  );
  const menu = new Menu(opener, pages);
  // Before the page opens: it gives the focus back to what had it.
  pages.addEventListener(
    'click',
    () => {
      if (menu.isOpen) opener.focus();
      menu.close();
    },
    { capture: true },
  );
  menu.root.classList.add('pages-menu');
  return menu.root;
}

/** Of the pages over the dashboard. */
function pageButtons(context: Context): HTMLElement[] {
  return [
    pageButton('calibration', 'Calibrate', 'Calibrate a camera', () => context.calibration.open()),
    pageButton('missions', 'Missions', 'Draw missions on a map, check and fly them', () =>
      context.missions.open(),
    ),
    pageButton('sweeps', 'Sweeps', 'Many flights with changed fields, and what they found', () =>
      context.sweeps.open(),
    ),
    pageButton(
      'studies',
      'Studies',
      'Why a run failed, where a flight is risky, which flight is the worst',
      () => context.studies.open(),
    ),
    pageButton('scores', 'Score files', 'Score trajectories of files, runs and logs', () =>
      context.scores.open(),
    ),
  ];
}

function pageButton(
  name: string,
  label: string,
  title: string,
  open: () => Promise<void>,
): HTMLElement {
  return h(
    'button',
    { class: 'tab', 'data-role': `open-${name}`, title, onclick: () => void open() },
    label,
  );
}
