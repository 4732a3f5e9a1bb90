// The images of a calibration at work: the newest one beside the last view, the coverage, the
// residuals of the views, and what can be done.
import { phaseText, viewRows } from '../../store/calibration/calibration_results';
import type { CalibrationPage } from '../../store/calibration/calibration_page';
import type { CalibrationSession, SearchedImage } from '../../protocol/calibration_types';
import { h, setText } from '../dom';
import type { Context } from '../view';
import type { BoardPictureContent } from './board_picture';
import { BoardPicture, kResidualScale } from './board_picture';
import { CoverageBars } from './coverage_bars';
import { ResidualBars } from './residual_bars';

const kVerdicts: Readonly<Record<string, string>> = {
  taken: 'taken',
  'no board': 'no board in the image, or not all of it',
  'near duplicate': 'too similar to a view',
  'board moves': 'hold the board still',
  'nothing new': 'show it elsewhere, nearer, or tilted',
  'not asked for': 'board found',
  'enough views': 'enough views were taken',
};

export class CaptureView {
  readonly root: HTMLElement;
  private readonly phase = h('span', { class: 'calibration-phase', 'data-role': 'phase' });
  private readonly bar = h('div', { class: 'upload-bar' });
  private readonly track = h('div', { class: 'upload-track' }, this.bar);
  private readonly automatic = h('input', { type: 'checkbox', id: 'calibration-automatic' });
  private readonly automaticLabel = h(
    'label',
    {
      class: 'calibration-check',
      'data-changes': true,
      title: 'Takes a view when it adds to the coverage and the board is held still',
    },
    this.automatic,
    'Take useful views',
  );
  private readonly capture = button(
    'Take now',
    'capture',
    'Takes the next image that shows the board',
  );
  private readonly finish = button('No more images', 'finish', 'Ends the source; the views stay');
  private readonly clear = button('Forget views', 'clear', 'Begins again with the same source');
  private readonly leave = button(
    'End',
    'end-calibration',
    'Ends the calibration and forgets its views',
  );
  private readonly send = button(
    'Choose images',
    'choose-images',
    'PNG or JPEG; files can be dropped, too',
  );
  private readonly file = h('input', {
    type: 'file',
    multiple: true,
    accept: 'image/png,image/jpeg',
    hidden: true,
    'data-role': 'calibration-file',
  });
  private readonly newest = new BoardPicture('Newest image', 'The newest image appears here.');
  private readonly view = new BoardPicture('Last view', 'Images that give a view appear here.');
  private readonly bars = new CoverageBars();
  private readonly plot: ResidualBars;
  private readonly error = h('p', { class: 'calibration-warning', role: 'alert' });

  constructor(private readonly context: Context) {
    const { calibration } = context;
    this.plot = new ResidualBars((view) => {
      const { selected } = context.store.state.calibrationPage;
      void calibration.select(selected === view ? null : view);
    });
    this.automatic.addEventListener('change', () => {
      void calibration.control({ automatic: this.automatic.checked });
    });
    this.capture.addEventListener('click', () => void calibration.control({ capture: true }));
    this.finish.addEventListener('click', () => void calibration.control({ finish: true }));
    this.clear.addEventListener('click', () => void calibration.control({ clear: true }));
    this.leave.addEventListener('click', () => void calibration.end());
    this.send.addEventListener('click', () => this.file.click());
    this.file.addEventListener('change', () => {
      void calibration.send([...(this.file.files ?? [])]).then(() => (this.file.value = ''));
    });
    this.root = h(
      'div',
      { class: 'calibration-capture' },
      h(
        'div',
        { class: 'calibration-tools' },
        this.phase,
        this.automaticLabel,
        this.send,
        this.capture,
        this.finish,
        this.clear,
        this.leave,
        this.file,
      ),
      this.track,
      this.error,
      h('div', { class: 'board-pictures' }, this.newest.root, this.view.root),
      this.bars.root,
      this.plot.root,
    );
  }

  update(): void {
    const page = this.context.store.state.calibrationPage;
    const { session } = page;
    const errors = [page.error, session?.error, session?.solve_error, page.pollError];
    setText(this.error, errors.find((error) => typeof error === 'string') ?? '');
    this.error.hidden = this.error.textContent === '';
    this.updateTools(page);
    this.bars.show(session?.coverage ?? []);
    this.newest.show(session?.newest ? this.content(session, session.newest) : null);
    this.view.show(this.shownView(page));
    this.plot.show(viewRows(page), page.solution?.rms_px ?? null, page.selected);
  }

  private updateTools({ session, sending, busy }: CalibrationPage): void {
    const open = session?.source_open === true;
    setText(
      this.phase,
      session === null
        ? this.idleText()
        : sending === null
          ? phaseText(session)
          : `Sending image ${sending.done + 1} of ${sending.total}; ${phaseText(session)}`,
    );
    this.phase.dataset['phase'] = session?.phase ?? '';
    const endless = open && session.images_total === null;
    this.automaticLabel.hidden = !endless;
    if (session !== null) this.automatic.checked = session.automatic;
    this.capture.hidden = !endless || session.uploads;
    this.send.hidden = !open || !session.uploads;
    this.finish.hidden = !open;
    this.clear.hidden = !endless;
    this.leave.hidden = session === null;
    for (const one of [this.capture, this.finish, this.clear, this.leave]) one.disabled = busy;
    const share = session?.images_total ? session.images / session.images_total : null;
    // Keeps its place, so that the pictures do not move when the images have ended.
    this.track.style.visibility = share === null || !open ? 'hidden' : '';
    this.bar.style.width = `${100 * (share ?? 0)}%`;
  }

  private idleText(): string {
    const { mayChange } = this.context.store.state;
    return mayChange ? 'Choose images and board, then start.' : 'No camera is being calibrated.';
  }

  private content(session: CalibrationSession, image: SearchedImage): BoardPictureContent {
    const verdict = kVerdicts[image.verdict] ?? image.verdict;
    return {
      image,
      url: this.context.calibration.imageUrl(image.number),
      caption: `${image.name}: ${verdict}`,
      cols: session.board.cols,
      rows: session.board.rows,
      residuals: null,
    };
  }

  /** The selected view with its residuals, else the last one. */
  private shownView({ session, selected, detail }: CalibrationPage): BoardPictureContent | null {
    if (session === null) return null;
    if (selected !== null && detail !== null) {
      const scale = detail.residuals === null ? '' : `; residuals x ${kResidualScale}`;
      return {
        ...this.content(session, detail),
        caption: `View ${detail.view + 1}, ${detail.name}${scale}`,
        residuals: detail.residuals,
      };
    }
    if (session.last_view === null) return null;
    const caption = `View ${session.views.length}, ${session.last_view.name}`;
    return { ...this.content(session, session.last_view), caption };
  }
}

function button(label: string, role: string, hint: string): HTMLButtonElement {
  return h(
    'button',
    {
      class: 'secondary',
      'data-role': role,
      'data-changes': true,
      title: hint,
      hidden: true,
    },
    label,
  );
}
