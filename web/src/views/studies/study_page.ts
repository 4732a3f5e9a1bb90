// The page of studies: why a run failed, where a flight is risky, which flight is the worst.
import type { StudyEntry } from '../../protocol/study_types';
import { isOpen } from '../../protocol/study_types';
import type { Topic } from '../../store/state';
import { studyDetail } from '../../store/studies/study_words';
import { viewerNote } from '../access';
import { h, rebuild, setAttribute, setText, setTextOf } from '../dom';
import { KeyedList } from '../keyed_list';
import type { Context, View } from '../view';
import { prepareStudy } from './prepare_study';
import { StudyFormView } from './study_form_view';
import { StudyHead } from './study_head';
import { resultParts } from './study_results';

export class StudyPageView implements View {
  readonly root: HTMLElement;
  private readonly list = h('ul', { class: 'log-rows', 'aria-label': 'Studies' });
  private readonly drawn = new KeyedList(this.list);
  private readonly head: StudyHead;
  private readonly form: StudyFormView;
  private readonly result = h('div', { class: 'sweep-body study-body', tabindex: 0 });
  private readonly message = h('div', { class: 'log-message', 'data-role': 'study-message' });

  constructor(private readonly context: Context) {
    const { studies } = context;
    this.head = new StudyHead(context);
    this.form = new StudyFormView(context);
    const close = h(
      'button',
      { class: 'icon-button', 'aria-label': 'Close', onclick: () => studies.close() },
      '×',
    );
    const start = (role: string, label: string, title: string, action: () => void) =>
      h('button', { class: 'secondary', 'data-role': role, title, onclick: action }, label);
    this.root = h(
      'div',
      { class: 'sweep-page study-page', role: 'dialog', 'aria-label': 'Studies' },
      h('header', { class: 'log-header' }, h('h2', {}, 'Studies'), close),
      h(
        'div',
        { class: 'log-list sweep-list' },
        h(
          'div',
          { class: 'study-new', 'data-changes': true },
          start(
            'new-explain',
            'Explain a run',
            'Why an estimator failed',
            () => void studies.explain(null),
          ),
          start('new-predict', 'Predict risk', 'Where an estimator is likely to be lost', () =>
            prepareStudy(context, 'predict'),
          ),
          start('new-hunt', 'Hunt the worst flight', 'Within limits of some fields', () =>
            prepareStudy(context, 'hunt'),
          ),
        ),
        viewerNote(),
        this.list,
      ),
      h(
        'div',
        { class: 'sweep-centre' },
        this.head.root,
        this.message,
        this.result,
        this.form.root,
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('studies') && !changed.has('lists')) return;
    const { studyPage: page } = this.context.store.state;
    if (!page.open) return;
    this.drawList(page.studies ?? [], page.name);
    this.form.draw();
    setText(this.message, this.messageText());
    this.message.hidden = this.message.textContent === '';
    this.message.classList.toggle('failed', page.error !== null);
    const { shown } = page;
    this.head.root.hidden = shown === null;
    this.result.hidden = shown === null;
    if (shown === null) return;
    this.head.draw(shown.study);
    const key = JSON.stringify([shown.study.name, shown.result]);
    rebuild(this.result, key, () => resultParts(this.context, shown));
  }

  private messageText(): string {
    const { mayChange, studyPage } = this.context.store.state;
    const { error, studies, shown } = studyPage;
    if (error !== null) return error;
    if (studies === null) return 'Reading';
    if (studies.length === 0) {
      if (!mayChange) return 'There are no studies yet.';
      return 'There are no studies yet. Explain a run that failed, predict where a flight is risky, or hunt the worst flight within limits.';
    }
    if (shown === null || shown.result !== null) return '';
    return isOpen(shown.study) ? 'Nothing is found yet.' : 'It has found nothing.';
  }

  private drawList(studies: readonly StudyEntry[], chosen: string | null): void {
    this.drawn.show(
      studies.map((study) => ({
        id: study.name,
        key: study.title,
        make: () => this.entry(study),
        refresh: (entry) => {
          const state = study.cancelling ? 'cancelling' : study.state;
          setAttribute(entry, 'aria-current', study.name === chosen ? 'true' : null);
          setTextOf(entry, '.sweep-detail', `${state} · ${studyDetail(study)}`);
          entry.querySelector('button')?.setAttribute('data-state', study.state);
        },
      })),
    );
  }

  private entry({ name, kind, title }: StudyEntry): HTMLElement {
    return h(
      'li',
      { class: 'log-row' },
      h(
        'button',
        {
          class: 'log-choice',
          'data-study': name,
          'data-kind': kind,
          title,
          onclick: () => void this.context.studies.choose(name),
        },
        h('span', { class: 'log-name' }, title),
        h('span', { class: 'sweep-detail' }),
      ),
    );
  }
}
