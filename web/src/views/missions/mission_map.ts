// The map of a mission: the world's imagery, the items and their path, what the camera sees.
import 'leaflet/dist/leaflet.css';
import * as L from 'leaflet';
import type { MissionReport, World } from '../../protocol/mission_types';
import type { MissionPage } from '../../store/missions/mission_page';
import { h } from '../dom';
import { paint } from '../paint';
import { MapItems } from './map_items';
import { cursorSample, pathParts } from './map_paths';

const kOverzoom = 4;
const kPad_px = 40;

export interface MapActions {
  /** A click on the ground. */
  onGround: (place: [number, number]) => void;
  onSelect: (id: number | null) => void;
  /** An item was dragged; null = home. */
  onMove: (id: number | null, place: [number, number]) => void;
  /** A new waypoint at this index. */
  onInsert: (index: number, place: [number, number]) => void;
  onHover: (place: [number, number] | null) => void;
  onCursor: (distance_m: number | null) => void;
}

export class MissionMap {
  readonly root = h('div', {
    class: 'mission-map',
    'data-role': 'mission-map',
    'aria-label': 'Map of the mission',
  });
  /** Leaflet positions its element itself. */
  private readonly place = h('div', { class: 'mission-leaflet' });
  private readonly map: L.Map;
  private readonly items: MapItems;
  private readonly paths = L.layerGroup();
  private readonly footprints = L.layerGroup();
  private readonly cursor = L.circleMarker([0, 0], { radius: 6, interactive: false });
  private tiles: L.TileLayer | null = null;
  private outline: L.Polygon | null = null;
  private worldKey = '';
  private drawn: MissionReport | null = null;
  private showsFootprints = true;
  private placing = false;

  constructor(
    private readonly actions: MapActions,
    private readonly tileAddress: (world: World) => string,
  ) {
    this.root.append(this.place);
    // Its own credit line would read a world's credit as HTML.
    this.map = L.map(this.place, {
      attributionControl: false,
      zoomControl: false,
      zoomSnap: 0.5,
      keyboard: false,
      doubleClickZoom: false,
    });
    this.map.setView([0, 0], 2);
    L.control.zoom({ position: 'topright' }).addTo(this.map);
    L.control.scale({ imperial: false, position: 'bottomright' }).addTo(this.map);
    this.footprints.addTo(this.map);
    this.paths.addTo(this.map);
    this.items = new MapItems(this.map, actions);
    this.map.on('click', ({ latlng }) => actions.onGround(pairOf(latlng)));
    this.map.on('mousemove', ({ latlng }) => actions.onHover(pairOf(latlng)));
    this.map.on('mouseout', () => actions.onHover(null));
    new ResizeObserver(() => this.map.invalidateSize({ animate: false })).observe(this.root);
  }

  show(page: MissionPage): void {
    this.showWorld(page.world);
    if (page.draft !== null) this.items.show(page.draft.mission, page.selected, page.report);
    if (this.drawn !== page.report) {
      this.drawn = page.report;
      this.drawReport();
    }
    this.root.classList.toggle('outdated', page.outdated);
    this.showCursor(page);
  }

  /** Draws everything again, in the colours of the theme. */
  repaint(): void {
    this.drawReport();
    this.outline?.setStyle({ color: paint('var(--outline)') });
    this.items.repaint();
  }

  setPlacing(placing: boolean): void {
    this.placing = placing;
    this.root.classList.toggle('placing', placing);
  }

  setFootprints(shown: boolean): void {
    this.showsFootprints = shown;
    this.drawReport();
  }

  /** Shows the whole mission, or the world if there is none. */
  fit(): void {
    const bounds = this.items.bounds() ?? this.outline?.getBounds();
    if (bounds?.isValid() === true) {
      this.map.fitBounds(bounds, { padding: [kPad_px, kPad_px], animate: false });
    }
  }

  goTo(place: readonly [number, number]): void {
    this.map.panTo([place[0], place[1]], { animate: false });
  }

  middle(): [number, number] {
    return pairOf(this.map.getCenter());
  }

  showCursor({ report, cursor_m }: MissionPage): void {
    const at = report === null || cursor_m === null ? null : cursorSample(report.samples, cursor_m);
    if (report === null || at === null) {
      this.cursor.remove();
      return;
    }
    const { lat_deg, lon_deg } = report.samples;
    this.cursor.setLatLng([lat_deg[at] ?? 0, lon_deg[at] ?? 0]);
    this.cursor.setStyle({
      color: paint('var(--over)'),
      fillColor: paint('var(--over-text)'),
      fillOpacity: 1,
      weight: 2,
    });
    this.cursor.addTo(this.map);
  }

  private showWorld(world: World | null): void {
    const key = world === null ? '' : `${world.name} ${world.version}`;
    if (key === this.worldKey) return;
    this.worldKey = key;
    this.tiles?.remove();
    this.outline?.remove();
    this.tiles = null;
    this.outline = null;
    if (world === null) return;
    const { south_deg, west_deg, north_deg, east_deg } = world.bounds;
    this.tiles = L.tileLayer(this.tileAddress(world), {
      tileSize: world.tile_px,
      minZoom: 0,
      maxNativeZoom: world.max_zoom,
      maxZoom: world.max_zoom + kOverzoom,
      bounds: [
        [south_deg, west_deg],
        [north_deg, east_deg],
      ],
    }).addTo(this.map);
    this.map.setMinZoom(world.min_zoom);
    this.map.setMaxZoom(world.max_zoom + kOverzoom);
    this.outline = L.polygon(
      world.outline.map(({ lat_deg, lon_deg }) => [lat_deg, lon_deg]),
      {
        color: paint('var(--outline)'),
        weight: 1.5,
        dashArray: '6 4',
        fill: false,
        interactive: false,
      },
    ).addTo(this.map);
    this.map.fitBounds(this.outline.getBounds(), { animate: false });
    this.root.dataset['world'] = world.name;
  }

  private drawReport(): void {
    this.paths.clearLayers();
    this.footprints.clearLayers();
    const report = this.drawn;
    if (report === null) return;
    if (this.showsFootprints) {
      for (const { corners } of report.footprints) {
        L.polygon(corners, {
          color: paint('var(--over-text)'),
          weight: 0.7,
          opacity: 0.55,
          fillOpacity: 0.05,
          interactive: false,
        }).addTo(this.footprints);
      }
    }
    for (const { kind, points } of pathParts(report)) {
      // A dark edge keeps the line visible on bright ground.
      L.polyline(points, { color: paint('var(--over)'), weight: 6, interactive: false }).addTo(
        this.paths,
      );
      L.polyline(points, { color: paint(kPathColours[kind]), weight: 3, interactive: false }).addTo(
        this.paths,
      );
    }
    L.polyline(
      report.samples.lat_deg.map((lat, i) => [lat, report.samples.lon_deg[i] ?? 0]),
      { opacity: 0, weight: 16 },
    )
      .on('mousemove', ({ latlng }: L.LeafletMouseEvent) => this.hoverPath(latlng))
      .on('mouseout', () => this.actions.onCursor(null))
      .on('click', (event: L.LeafletMouseEvent) => {
        // A click on the path selects nothing, but places an item there.
        if (!this.placing) L.DomEvent.stopPropagation(event);
      })
      .addTo(this.paths);
  }

  private hoverPath(latlng: L.LatLng): void {
    const samples = this.drawn?.samples;
    if (samples === undefined) return;
    let best = 0;
    let least = Infinity;
    samples.lat_deg.forEach((lat, i) => {
      const distance = this.map.distance(latlng, [lat, samples.lon_deg[i] ?? 0]);
      if (distance < least) {
        least = distance;
        best = i;
      }
    });
    this.actions.onCursor(samples.distance_m[best] ?? null);
  }
}

const kPathColours = {
  plain: 'var(--path)',
  start: 'var(--path-start)',
  warned: 'var(--path-warned)',
} as const;

function pairOf({ lat, lng }: L.LatLng): [number, number] {
  return [lat, lng];
}
