// Status of the estimators as a panel of its own.
import { withResults } from '../../store/runs/counted_results';
import type { Topic } from '../../store/state';
import { failedEstimators } from '../../store/studies/study_form';
import { h } from '../dom';
import { EstimatorTable } from './estimator_table';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import type { Context, View } from '../view';

const kShown: readonly Topic[] = ['run', 'metrics', 'estimators', 'log'];

export class StatusPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly table = new EstimatorTable();
  private readonly explain = h(
    'button',
    {
      class: 'tab',
      hidden: true,
      'data-role': 'explain-status',
      'data-changes': true,
      title: 'Find out why an estimator failed: fly it again with one cause changed at a time',
      onclick: () => void this.context.studies.explain(withResults(this.context.store.state.main)),
    },
    'Explain',
  );

  constructor(private readonly context: Context) {
    this.panel = makePanel('status', 'Estimator status');
    this.panel.body.append(this.table.root);
    this.panel.tools.append(this.explain);
    this.root = this.panel.root;
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!kShown.some((topic) => changed.has(topic))) return;
    const { state } = this.context.store;
    const none = (state.run?.estimators.length ?? 0) === 0;
    this.table.root.hidden = none;
    this.panel.showEmpty(none ? 'The status of estimators appears here.' : null);
    this.table.draw(state);
    const run = withResults(state.main);
    this.explain.hidden = run === null || failedEstimators(run).length === 0;
  }
}
