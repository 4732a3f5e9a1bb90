// The items of a mission on the map: markers that are dragged, circles, lines between them.
import * as L from 'leaflet';
import type { MissionReport } from '../../protocol/mission_types';
import type { Mission, MissionItem } from '../../store/missions/mission_item';
import {
  isCircle,
  isFlown,
  itemTitle,
  kCommand,
  numbersOf,
  placeOf,
  radiusOf,
} from '../../store/missions/mission_item';
import { expandedItems } from '../../store/missions/plan_file';
import { h } from '../dom';
import { paint } from '../paint';
import type { MapActions } from './mission_map';

const kSize_px = 24;
const kHandle_px = 14;
const kUsualRadius_m = 60;

export class MapItems {
  private readonly lines = L.layerGroup();
  private readonly handles = L.layerGroup();
  private readonly markers = new Map<number, L.Marker>();
  private readonly home: L.Marker;
  private shown: Mission | null = null;
  private selected: number | null = null;
  private warned: ReadonlySet<number> = new Set();
  private dragging = false;

  constructor(
    private readonly map: L.Map,
    private readonly actions: MapActions,
  ) {
    this.lines.addTo(map);
    this.handles.addTo(map);
    this.home = L.marker([0, 0], {
      draggable: true,
      icon: this.iconOf('H', 'home'),
      title: 'Home: heights above home count from the ground here',
      alt: 'Home',
    });
    this.home.on('dragend', () => this.dropped(null, this.home));
    this.home.on('click', () => actions.onSelect(null));
  }

  show(mission: Mission, selected: number | null, report: MissionReport | null): void {
    if (this.dragging) return;
    const warned = new Set(
      report?.warnings.flatMap(({ item, kind }) =>
        item === null || kind === 'plan' ? [] : [item],
      ) ?? [],
    );
    const same = this.shown === mission && this.selected === selected;
    if (same && equal(this.warned, warned)) return;
    this.shown = mission;
    this.selected = selected;
    this.warned = warned;
    this.draw(mission);
  }

  repaint(): void {
    if (this.shown !== null) this.draw(this.shown);
  }

  /** null without items. */
  bounds(): L.LatLngBounds | null {
    const { shown } = this;
    if (shown === null || shown.items.length === 0) return null;
    const places = shown.items.flatMap((item) => placesOf(item));
    const { lat_deg, lon_deg } = shown.home;
    return L.latLngBounds([...places, [lat_deg, lon_deg]]);
  }

  private draw(mission: Mission): void {
    const { lat_deg, lon_deg } = mission.home;
    this.home.setLatLng([lat_deg, lon_deg]).addTo(this.map);
    const numbers = numbersOf(mission);
    const ids = new Set(mission.items.map(({ id }) => id));
    for (const [id, marker] of this.markers) {
      if (!ids.has(id)) {
        marker.remove();
        this.markers.delete(id);
      }
    }
    mission.items.forEach((item, i) => {
      const place = placeOf(item);
      if (place === null) {
        this.markers.get(item.id)?.remove();
        this.markers.delete(item.id);
      } else {
        this.drawMarker(item, numbers[i] ?? 0, place);
      }
    });
    this.drawLines(mission);
  }

  private drawMarker(item: MissionItem, number: number, place: readonly [number, number]): void {
    const kind = item.kind === 'simple' && !isFlown(item.command) ? 'other' : 'item';
    const icon = this.iconOf(
      String(number),
      kind,
      item.id === this.selected,
      this.warned.has(number),
    );
    const title = `${number}: ${itemTitle(item)}`;
    const known = this.markers.get(item.id);
    if (known !== undefined) {
      known.setLatLng([place[0], place[1]]).setIcon(icon);
      known.getElement()?.setAttribute('title', title);
      return;
    }
    const marker = L.marker([place[0], place[1]], { draggable: true, icon, title, alt: title });
    marker.on('click', () => this.actions.onSelect(item.id));
    marker.on('dragstart', () => {
      this.dragging = true;
      this.actions.onSelect(item.id);
    });
    marker.on('drag', () => this.dragLines(item.id, marker.getLatLng()));
    marker.on('dragend', () => this.dropped(item.id, marker));
    marker.addTo(this.map);
    this.markers.set(item.id, marker);
  }

  private dropped(id: number | null, marker: L.Marker): void {
    this.dragging = false;
    const { lat, lng } = marker.getLatLng();
    this.actions.onMove(id, [lat, lng]);
  }

  /** Lines follow the mouse while an item is dragged. */
  private dragLines(id: number, { lat, lng }: L.LatLng): void {
    const { shown } = this;
    if (shown === null) return;
    const items = shown.items.map((item): MissionItem => {
      if (item.id !== id || item.kind !== 'simple') return item;
      const params = [...item.params];
      params.splice(4, 2, lat, lng);
      return { ...item, params };
    });
    this.drawLines({ ...shown, items });
  }

  private drawLines(mission: Mission): void {
    this.lines.clearLayers();
    this.handles.clearLayers();
    const { lat_deg, lon_deg } = mission.home;
    let before: L.LatLngTuple = [lat_deg, lon_deg];
    mission.items.forEach((item, index) => {
      const places = item.kind === 'simple' && returnsHome(item) ? [mission.home] : null;
      const points: L.LatLngTuple[] = places === null ? placesOf(item) : [[lat_deg, lon_deg]];
      const [first] = points;
      if (first === undefined) return;
      this.line([before, ...points]);
      if (places === null && !this.dragging) this.handle(before, first, index);
      before = points.at(-1) ?? before;
      if (item.kind === 'simple' && isCircle(item.command)) {
        L.circle(before, {
          radius: radiusOf(item) ?? kUsualRadius_m,
          color: paint('var(--over-text)'),
          weight: 1.5,
          dashArray: '4 4',
          fill: false,
          interactive: false,
        }).addTo(this.lines);
      }
    });
  }

  private line(points: L.LatLngTuple[]): void {
    L.polyline(points, {
      color: paint('var(--over-text)'),
      weight: 1.5,
      opacity: 0.8,
      dashArray: '4 4',
      interactive: false,
    }).addTo(this.lines);
  }

  /** A click on the middle of a line, or a drag from there, inserts a waypoint. */
  private handle(from: L.LatLngTuple, to: L.LatLngTuple, index: number): void {
    const middle: L.LatLngTuple = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
    if (this.map.latLngToLayerPoint(from).distanceTo(this.map.latLngToLayerPoint(to)) < 40) return;
    const marker = L.marker(middle, {
      draggable: true,
      keyboard: false,
      title: 'Insert a waypoint here',
      icon: L.divIcon({
        className: 'mission-handle',
        html: h('span', {}, '+'),
        iconSize: [kHandle_px, kHandle_px],
      }),
    });
    const insert = () => {
      const { lat, lng } = marker.getLatLng();
      this.actions.onInsert(index, [lat, lng]);
    };
    marker.on('click', insert);
    marker.on('dragend', insert);
    marker.addTo(this.handles);
  }

  private iconOf(text: string, kind: string, selected = false, warned = false): L.DivIcon {
    return L.divIcon({
      className: `mission-marker ${kind}${selected ? ' selected' : ''}${warned ? ' warned' : ''}`,
      html: h('span', {}, text),
      iconSize: [kSize_px, kSize_px],
    });
  }
}

function returnsHome(item: { command: number }): boolean {
  return item.command === kCommand.home;
}

/** The places of an item, several of a survey. */
function placesOf(item: MissionItem): L.LatLngTuple[] {
  if (item.kind === 'simple') {
    const place = placeOf(item);
    return place === null ? [] : [[place[0], place[1]]];
  }
  return expandedItems(item.raw).flatMap((inner) => {
    const place = placeOf({ id: 0, ...inner });
    return place === null ? [] : [[place[0], place[1]] as L.LatLngTuple];
  });
}

function equal(a: ReadonlySet<number>, b: ReadonlySet<number>): boolean {
  return a.size === b.size && [...a].every((value) => b.has(value));
}
