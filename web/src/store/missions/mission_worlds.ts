// The worlds over which missions are drawn: listed, opened, made.
import type { RestClient } from '../../connection/rest_client';
import { errorText, RestError } from '../../connection/rest_error';
import type { Store } from '../state';
import { isInside } from './mission_document';
import type { Home } from './mission_item';
import type { MissionPage } from './mission_page';

const kPoll_ms = 500;
const kNowhere: Home = { lat_deg: 0, lon_deg: 0, alt_msl_m: 0 };

export class MissionWorlds {
  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly later: (callback: () => void, delay_ms: number) => void,
    private readonly newKey: () => string,
  ) {}

  async read(): Promise<void> {
    try {
      this.page.worlds = await this.rest.worlds();
      this.page.listError = null;
    } catch (error) {
      this.page.listError = errorText(error);
    }
    this.changed();
  }

  async open(name: string): Promise<void> {
    const { page } = this;
    page.world = null;
    page.worldError = null;
    page.worldMissing = false;
    page.report = null;
    this.changed();
    try {
      const world = await this.rest.world(name);
      if (this.isWanted(name)) page.world = world;
    } catch (error) {
      if (!this.isWanted(name)) return;
      page.worldMissing = error instanceof RestError && error.status === 409;
      page.worldError = page.worldMissing ? null : errorText(error);
    }
    this.changed();
  }

  private isWanted(name: string): boolean {
    const { draft } = this.page;
    return draft === null || draft.world === name;
  }

  /** Makes a built-in world, with progress, and opens it if it is still wanted. */
  async make(name: string): Promise<void> {
    const { page } = this;
    if (page.making !== null) return;
    const id = this.newKey();
    page.making = 0;
    this.changed();
    this.watch(id);
    try {
      await this.rest.makeWorld(name, id);
    } catch (error) {
      // Making it takes longer than the server lets a request wait: it goes on.
      if (error instanceof RestError && error.code === 'timeout') await this.untilMade(id);
      else page.worldError = errorText(error);
    }
    page.making = null;
    await this.read();
    if (page.draft?.world === name && page.worldError === null) await this.open(name);
  }

  private watch(id: string): void {
    const look = async () => {
      const progress = await this.rest.progress(id);
      if (this.page.making === null) return;
      if (progress !== null) this.page.making = progress.share;
      this.changed();
      this.watch(id);
    };
    this.later(() => void look(), kPoll_ms);
  }

  private async untilMade(id: string): Promise<void> {
    while ((await this.rest.progress(id)) !== null) {
      await new Promise<void>((resolve) => this.later(resolve, kPoll_ms));
    }
  }

  /** The runway, else the middle of the imagery. */
  usualHome(): Home {
    const { world } = this.page;
    if (world === null) return kNowhere;
    const { lat_deg, lon_deg, alt_ellipsoid_m } = world.runway ?? world.centre;
    const alt_msl_m = Math.round((alt_ellipsoid_m - world.sea_level_ellipsoid_m) * 10) / 10;
    return { lat_deg, lon_deg, alt_msl_m };
  }

  /** Whether the mission's home lies outside of the world's imagery. */
  get isElsewhere(): boolean {
    const { world, draft } = this.page;
    if (world === null || draft === null) return false;
    const { lat_deg, lon_deg } = draft.mission.home;
    return !isInside(world, lat_deg, lon_deg);
  }

  private get page(): MissionPage {
    return this.store.state.missionPage;
  }

  private changed(): void {
    this.store.change('missions');
  }
}
