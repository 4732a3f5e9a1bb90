// The fields that a hunt searches, with their limits, as rows of its form.
import { huntFieldsOf } from '../../store/studies/hunt_fields';
import type { AxisRow, StudyFormState } from '../../store/studies/study_form';
import { h } from '../dom';
import type { Context } from '../view';

const kFieldList = 'study-fields';

/** @param most  fields */
export function huntAxes(context: Context, form: StudyFormState, most: number): HTMLElement {
  const { form: actions } = context.studies;
  const known = huntFieldsOf(form.document ?? {});
  const heads = ['Field of the scenario', 'From', 'To', 'Step', 'Unit', ''];
  return h(
    'div',
    { class: 'study-wide' },
    h(
      'datalist',
      { id: kFieldList },
      ...known.map(({ path, label }) => h('option', { value: path }, label)),
    ),
    h(
      'table',
      { class: 'study-axes', 'data-role': 'study-axes' },
      h('thead', {}, h('tr', {}, ...heads.map((text) => h('th', { scope: 'col' }, text)))),
      h(
        'tbody',
        {},
        ...form.axes.map((axis, i) => {
          const unit = known.find(({ path }) => path === axis.path)?.unit ?? '';
          return h(
            'tr',
            {},
            h('td', {}, axisText(context, axis, i, 'path')),
            h('td', {}, axisText(context, axis, i, 'from')),
            h('td', {}, axisText(context, axis, i, 'to')),
            h('td', {}, axisText(context, axis, i, 'step')),
            h('td', { class: 'unit' }, unit),
            h(
              'td',
              {},
              h(
                'button',
                {
                  class: 'icon-button',
                  'aria-label': `Leave out ${axis.path}`,
                  title: 'Leave out this field',
                  onclick: () => actions.removeAxis(i),
                },
                '×',
              ),
            ),
          );
        }),
      ),
    ),
    h(
      'button',
      {
        class: 'secondary',
        'data-role': 'add-axis',
        disabled: form.axes.length >= most || form.document === null,
        title: `At most ${most} fields`,
        onclick: () => actions.addAxis(),
      },
      'Add a field',
    ),
  );
}

function axisText(
  context: Context,
  axis: AxisRow,
  index: number,
  name: keyof AxisRow,
): HTMLElement {
  const { form: actions } = context.studies;
  const input = h('input', {
    type: 'text',
    inputmode: name === 'path' ? 'text' : 'decimal',
    class: name === 'path' ? 'study-path' : 'study-number',
    list: name === 'path' ? kFieldList : undefined,
    value: axis[name],
    placeholder: name === 'step' ? 'any' : '',
    'aria-label': `${name} of field ${index + 1}`,
    'data-role': `axis-${index}-${name}`,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  // A field that is chosen brings its limits: only when it is complete.
  const event = name === 'path' ? 'change' : 'input';
  input.addEventListener(event, () => actions.setAxis(index, { [name]: input.value }));
  return input;
}
