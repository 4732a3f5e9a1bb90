// The items of a mission in their order, and the fields of the selected one.
import type { MissionPlace, MissionReport } from '../../protocol/mission_types';
import { formatNumber } from '../../store/format';
import type { MissionDesk } from '../../store/missions/mission_desk';
import type { Mission, MissionItem, SimpleItem } from '../../store/missions/mission_item';
import {
  hasHeight,
  isFlown,
  itemTitle,
  kCommand,
  kFrame,
  numbersOf,
} from '../../store/missions/mission_item';
import type { MissionPage } from '../../store/missions/mission_page';
import { h, rebuild } from '../dom';
import { icon } from '../icons';
import { ItemForm } from './item_form';

export class ItemList {
  readonly root: HTMLElement;
  private readonly list = h('ol', {
    class: 'mission-items',
    'aria-label': 'Items of the mission',
    'data-role': 'mission-items',
  });
  private readonly empty = h(
    'p',
    { class: 'mission-empty' },
    'No items yet. Choose what to place above the map, then click the map.',
  );
  private readonly form: ItemForm;
  /** What was selected when the list was last shown. */
  private selected: number | null = null;

  constructor(private readonly desk: MissionDesk) {
    this.form = new ItemForm(desk);
    this.root = h('section', { class: 'mission-left' }, this.list, this.empty, this.form.root);
  }

  show(page: MissionPage): void {
    const { draft, selected, report } = page;
    const mission = draft?.mission;
    this.empty.hidden = mission === undefined || mission.items.length > 0;
    const places = placesByItem(report);
    const warned = warnedItems(report);
    const rows = mission === undefined ? [] : rowsOf(mission, places, warned);
    rebuild(this.list, JSON.stringify([rows, selected]), () =>
      rows.map((row) => this.row(row, row.id === selected)),
    );
    // Only to a new one: the page is drawn again whenever the runs are read.
    if (selected !== this.selected) {
      this.list.querySelector('[aria-current=true]')?.scrollIntoView({ block: 'nearest' });
    }
    this.selected = selected;
    this.form.show(page);
  }

  private row(row: Row, selected: boolean): HTMLElement {
    return h(
      'li',
      {
        'data-item': row.id,
        'data-number': row.number,
        'aria-current': selected ? 'true' : 'false',
      },
      h(
        'button',
        {
          class: 'mission-item',
          'data-role': 'select-item',
          title: row.hint,
          onclick: () => this.desk.select(row.id),
        },
        h('b', { class: row.warned ? 'warned' : '' }, String(row.number)),
        h('span', { class: 'mission-item-title' }, row.title),
        h('span', { class: 'mission-item-figure' }, row.height),
        h('span', { class: 'mission-item-figure' }, row.bank),
      ),
      h(
        'button',
        {
          class: 'icon-button',
          title: 'Delete this item (Del)',
          'aria-label': `Delete item ${row.number}`,
          'data-role': 'delete-item',
          onclick: () => this.desk.remove(row.id),
        },
        icon('bin'),
      ),
    );
  }
}

interface Row {
  id: number;
  number: number;
  title: string;
  height: string;
  bank: string;
  hint: string;
  warned: boolean;
}

function rowsOf(
  mission: Mission,
  places: ReadonlyMap<number, MissionPlace>,
  warned: ReadonlySet<number>,
): Row[] {
  const numbers = numbersOf(mission);
  return mission.items.map((item, i) => {
    const number = numbers[i] ?? 0;
    const place = places.get(number);
    const kept = item.kind === 'simple' && !isFlown(item.command);
    return {
      id: item.id,
      number,
      title: itemTitle(item),
      height: heightText(item),
      bank:
        place === undefined || place.turn_bank_deg === null
          ? ''
          : `${formatNumber(place.turn_bank_deg, 0)}°`,
      hint: kept ? 'Kept in the mission, but not flown' : hintOf(place),
      warned: warned.has(number) || kept,
    };
  });
}

function hintOf(place: MissionPlace | undefined): string {
  if (place === undefined) return '';
  const bank =
    place.turn_bank_deg === null
      ? ''
      : `, turn with ${formatNumber(place.turn_bank_deg, 0)}° of bank and a radius of ${formatNumber(place.turn_radius_m ?? 0, 0)} m`;
  return `${formatNumber(place.height_agl_m, 0)} m above the ground${bank}`;
}

function heightText(item: MissionItem): string {
  if (item.kind !== 'simple') return `${item.count} items`;
  if (item.command === kCommand.speed) return `${formatNumber(item.params[1] ?? 0, 0)} m/s`;
  if (!hasHeight(item)) return '';
  return `${formatNumber(item.params[6] ?? 0, 0)} m ${frameShort(item)}`;
}

function frameShort({ frame }: SimpleItem): string {
  if (frame === kFrame.aboveGround || frame === 11) return 'AGL';
  return frame === kFrame.seaLevel || frame === 5 ? 'AMSL' : 'rel.';
}

export function placesByItem(report: MissionReport | null): ReadonlyMap<number, MissionPlace> {
  return new Map(report?.items.map((place) => [place.item, place]) ?? []);
}

function warnedItems(report: MissionReport | null): ReadonlySet<number> {
  return new Set(
    report?.warnings.flatMap(({ item, kind }) => (item === null || kind === 'plan' ? [] : [item])),
  );
}
