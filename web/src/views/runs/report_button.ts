// Saves the report of the runs that are shown together as one HTML file.
import type { Topic } from '../../store/state';
import { download } from '../download';
import { h, setText } from '../dom';
import { icon } from '../icons';
import type { Context, View } from '../view';

export async function saveReport({ notices, reports }: Context): Promise<void> {
  const report = await reports.make();
  if (report === null) return;
  download(report.fileName, report.page);
  notices.info(`Saved as ${report.fileName}: maps, plots and tables in one file.`);
}

export class ReportButton implements View {
  readonly root = h('button', {
    class: 'icon-button report-button',
    'data-role': 'report',
    'aria-label': 'Report',
    hidden: true,
  });
  private readonly label = h('span');

  constructor(private readonly context: Context) {
    this.root.append(icon('download'), this.label);
    this.root.addEventListener('click', () => void saveReport(context));
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('run')) return;
    const { reports } = this.context;
    const count = reports.runs().length;
    this.root.hidden = count === 0;
    this.root.disabled = reports.busy;
    setText(this.label, reports.busy ? 'Writing…' : 'Report');
    const runs = count === 1 ? 'this run' : `the ${count} runs shown together`;
    this.root.title = `Save a report of ${runs}: one HTML file with maps, plots and tables`;
  }
}
