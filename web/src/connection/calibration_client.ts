// Calibrations of the REST interface as typed calls.
import type {
  CalibrationSession,
  CalibrationSolution,
  CalibrationSources,
  LensRequest,
  SavedCalibration,
  SessionRequest,
  ViewDetail,
} from '../protocol/calibration_types';
import type { RestClient } from './rest_client';

export interface SessionControl {
  automatic?: boolean;
  capture?: boolean;
  finish?: boolean;
  clear?: boolean;
}

export class CalibrationClient {
  constructor(private readonly rest: RestClient) {}

  async sources(): Promise<CalibrationSources> {
    return (await this.rest.call('GET', '/calibration-sources')) as CalibrationSources;
  }

  async sessions(): Promise<CalibrationSession[]> {
    const answer = await this.rest.call('GET', '/calibration-sessions');
    return (answer as { sessions: CalibrationSession[] }).sessions;
  }

  async begin(request: SessionRequest): Promise<CalibrationSession> {
    return (await this.rest.call('POST', '/calibration-sessions', request)) as CalibrationSession;
  }

  /** null if nothing has changed since `revision`. */
  async session(id: string, revision: number): Promise<CalibrationSession | null> {
    const query = `?revision=${revision}`;
    return (await this.rest.call('GET', `${place(id)}${query}`)) as CalibrationSession | null;
  }

  async end(id: string): Promise<void> {
    await this.rest.call('DELETE', place(id));
  }

  async control(id: string, control: SessionControl): Promise<CalibrationSession> {
    return (await this.rest.call('POST', `${place(id)}/control`, control)) as CalibrationSession;
  }

  async solve(
    id: string,
    lens: LensRequest,
    left_out: readonly number[],
  ): Promise<CalibrationSession> {
    const body = { ...lens, left_out };
    return (await this.rest.call('POST', `${place(id)}/solution`, body)) as CalibrationSession;
  }

  async solution(id: string): Promise<CalibrationSolution> {
    return (await this.rest.call('GET', `${place(id)}/solution`)) as CalibrationSolution;
  }

  async view(id: string, view: number): Promise<ViewDetail> {
    return (await this.rest.call('GET', `${place(id)}/views/${view}`)) as ViewDetail;
  }

  /** Waits while the server has enough images to search. */
  async uploadImage(id: string, name: string, image: Blob): Promise<void> {
    await this.rest.callWith('POST', `${place(id)}/images?name=${encodeURIComponent(name)}`, image);
  }

  imageUrl(id: string, image: number): string {
    return `${this.rest.base}${place(id)}/images/${image}.jpg`;
  }

  async saved(): Promise<SavedCalibration[]> {
    const answer = await this.rest.call('GET', '/calibrations');
    return (answer as { calibrations: SavedCalibration[] }).calibrations;
  }

  async save(session: string, name: string): Promise<SavedCalibration> {
    const body = { session, name };
    return (await this.rest.call('POST', '/calibrations', body)) as SavedCalibration;
  }

  async remove(name: string): Promise<void> {
    await this.rest.call('DELETE', `/calibrations/${encodeURIComponent(name)}`);
  }

  async file(name: string, format: string): Promise<Blob> {
    return this.rest.file(`/calibrations/${encodeURIComponent(name)}?format=${format}`);
  }
}

function place(id: string): string {
  return `/calibration-sessions/${encodeURIComponent(id)}`;
}
