// The REST calls about studies.
import type { JsonObject } from '../protocol/rest_types';
import type { StudyEntry, StudyList, StudyShown } from '../protocol/study_types';
import type { RestClient } from './rest_client';

export class StudyClient {
  constructor(private readonly rest: RestClient) {}

  /** The newest first. */
  async studies(): Promise<StudyList> {
    return (await this.rest.call('GET', '/studies')) as StudyList;
  }

  async study(name: string): Promise<StudyShown> {
    return (await this.rest.call('GET', placeOf(name))) as StudyShown;
  }

  /** Address of the page of an explanation or a prediction. */
  pageAddress(name: string): string {
    return `${this.rest.base}${placeOf(name)}/page`;
  }

  /** The scenario of a hunt's worst flight. */
  async worst(name: string): Promise<JsonObject> {
    return (await this.rest.call('GET', `${placeOf(name)}/worst`)) as JsonObject;
  }

  async start(request: JsonObject): Promise<StudyEntry> {
    return (await this.rest.call('POST', '/studies', request)) as StudyEntry;
  }

  async continue(name: string): Promise<StudyEntry> {
    return (await this.rest.call('POST', `${placeOf(name)}/continue`)) as StudyEntry;
  }

  async cancel(name: string): Promise<StudyEntry> {
    return (await this.rest.call('POST', `${placeOf(name)}/cancel`)) as StudyEntry;
  }

  async remove(name: string): Promise<void> {
    await this.rest.call('DELETE', placeOf(name));
  }
}

function placeOf(name: string): string {
  return `/studies/${encodeURIComponent(name)}`;
}
