// The REST interface as typed calls.
import type {
  LogEntry,
  LogInfo,
  LogList,
  LogResiduals,
  LogSeries,
  WorkProgress,
  WorldExtent,
} from '../protocol/log_types';
import type {
  Evaluation,
  EvaluationRequest,
  TrajectoryFile,
  TrajectoryList,
} from '../protocol/score_types';
import type { Cell } from '../protocol/messages';
import type {
  Heights,
  MissionReport,
  MissionRequest,
  World,
  WorldEntry,
} from '../protocol/mission_types';
import type { PixelAnswer, PixelQuestion } from '../protocol/pixel_types';
import type {
  Differences,
  Json,
  JsonObject,
  Manifest,
  Run,
  ScenarioEntry,
} from '../protocol/rest_types';
import type { SensorCurves } from '../protocol/sensor_types';

import type { FieldError } from '../protocol/field_errors';
import { readFieldErrors } from '../protocol/field_errors';
import { errorOf, RestError } from './rest_error';
import type { Upload } from './upload';

const kUnauthorized = 401;

export type Fetch = (url: string, init?: RequestInit) => Promise<Response>;

export class RestClient {
  constructor(
    readonly base: string,
    private readonly fetch: Fetch,
    /** Called when the server rejects this browser's token. */
    private readonly onLocked: () => void = () => {},
  ) {}

  async scenarios(): Promise<ScenarioEntry[]> {
    const answer = (await this.call('GET', '/scenarios')) as { scenarios: ScenarioEntry[] };
    return answer.scenarios;
  }

  async scenario(name: string): Promise<JsonObject> {
    return (await this.call('GET', `/scenarios/${encodeURIComponent(name)}`)) as JsonObject;
  }

  /** The server opens the world for it, which may take seconds. */
  async worldExtent(scenario: string): Promise<WorldExtent> {
    const place = `/scenarios/${encodeURIComponent(scenario)}/world`;
    return (await this.call('GET', place)) as WorldExtent;
  }

  async scenarioSchema(): Promise<JsonObject> {
    return (await this.call('GET', '/scenario-schema')) as JsonObject;
  }

  /** What a run of the document would be refused for. */
  async checkScenario(document: JsonObject, signal: AbortSignal): Promise<FieldError[]> {
    const answer = await this.call('POST', '/scenario-check', { document }, {}, signal);
    const { valid, message, faults } = answer as {
      valid: boolean;
      message: string;
      faults: unknown;
    };
    if (valid) return [];
    const errors = readFieldErrors(faults);
    return errors.length > 0 ? errors : [{ field: '', message }];
  }

  /** Saves a scenario of the viewer. */
  async saveScenario(name: string, document: JsonObject, replace: boolean): Promise<void> {
    const query = replace ? '?replace=true' : '';
    await this.call('PUT', `/scenarios/${encodeURIComponent(name)}${query}`, document);
  }

  async deleteScenario(name: string): Promise<void> {
    await this.call('DELETE', `/scenarios/${encodeURIComponent(name)}`);
  }

  /** The mission of a scenario as a plan. */
  async scenarioPlan(name: string): Promise<JsonObject> {
    return (await this.call('GET', `/scenarios/${encodeURIComponent(name)}/plan`)) as JsonObject;
  }

  async worlds(): Promise<WorldEntry[]> {
    return ((await this.call('GET', '/worlds')) as { worlds: WorldEntry[] }).worlds;
  }

  /** The server opens the world for it, which may take seconds. */
  async world(name: string): Promise<World> {
    return (await this.call('GET', `/worlds/${encodeURIComponent(name)}`)) as World;
  }

  /** Makes a built-in world. @param id  for progress(), of this request only */
  async makeWorld(name: string, id: string): Promise<World> {
    const place = `/worlds/${encodeURIComponent(name)}/make?progress=${encodeURIComponent(id)}`;
    return (await this.call('POST', place)) as World;
  }

  /** Address of a world's map tiles, with {z}, {x} and {y} in it. */
  tileAddress({ name, version }: World): string {
    const place = `${this.base}/worlds/${encodeURIComponent(name)}/tiles/{z}/{x}/{y}`;
    return `${place}?version=${encodeURIComponent(version)}`;
  }

  /** @param points  latitude and longitude */
  async heights(
    world: string,
    points: readonly (readonly [number, number])[],
    signal: AbortSignal,
  ): Promise<Heights> {
    const place = `/worlds/${encodeURIComponent(world)}/heights`;
    return (await this.call('POST', place, { points }, {}, signal)) as Heights;
  }

  /** The server stops working on it when `signal` aborts. */
  async missionReport(request: MissionRequest, signal: AbortSignal): Promise<MissionReport> {
    return (await this.call('POST', '/missions/report', request, {}, signal)) as MissionReport;
  }

  async manifest(run: string): Promise<Manifest> {
    return (await this.call('GET', `/runs/${encodeURIComponent(run)}/manifest`)) as Manifest;
  }

  /** Columns of an estimate under one of the score's alignments. */
  async estimate(run: string, name: string, alignment: string): Promise<Record<string, Cell[]>> {
    const place = `/runs/${encodeURIComponent(run)}/trajectories/${encodeURIComponent(name)}`;
    const query = `?format=json&alignment=${encodeURIComponent(alignment)}`;
    return (await this.call('GET', place + query)) as Record<string, Cell[]>;
  }

  /** @param span_s  null = the whole flight; @param points  most values of a curve */
  async sensors(
    run: string,
    span_s: readonly [number, number] | null,
    points: number,
    signal: AbortSignal,
  ): Promise<SensorCurves[]> {
    const part =
      span_s === null ? '' : `&from_s=${span_s[0].toFixed(6)}&to_s=${span_s[1].toFixed(6)}`;
    const place = `/runs/${encodeURIComponent(run)}/sensors?points=${points}${part}`;
    const answer = await this.call('GET', place, undefined, {}, signal);
    return (answer as { sensors: SensorCurves[] }).sensors;
  }

  /** What a pixel of a frame shows. */
  async pixel(question: PixelQuestion): Promise<PixelAnswer> {
    const { run, frame, x_px, y_px, camera, picture, alignment } = question;
    const query = new URLSearchParams({ x_px: x_px.toFixed(2), y_px: y_px.toFixed(2) });
    if (picture !== 'camera') query.set('picture', picture);
    if (camera !== null) query.set('camera', camera);
    if (picture.startsWith('error/')) query.set('alignment', alignment);
    const place = `/runs/${encodeURIComponent(run)}/frames/${frame}/pixel?${query.toString()}`;
    return (await this.call('GET', place)) as PixelAnswer;
  }

  async runs(): Promise<Run[]> {
    return ((await this.call('GET', '/runs')) as { runs: Run[] }).runs;
  }

  /** Repeated requests with the same `key` give the same run. */
  async startRun(scenario: string, overrides: Record<string, Json>, key: string): Promise<Run> {
    const headers = { 'Idempotency-Key': key };
    return (await this.call('POST', '/runs', { scenario, overrides }, headers)) as Run;
  }

  /** Flies a whole scenario. Repeated requests with the same `key` give the same run. */
  async startDocument(document: JsonObject, key: string): Promise<Run> {
    const headers = { 'Idempotency-Key': key };
    return (await this.call('POST', '/runs', { document }, headers)) as Run;
  }

  /** The scenario that a run flies or flew. */
  async runScenario(id: string): Promise<JsonObject> {
    return (await this.call('GET', `/runs/${encodeURIComponent(id)}/scenario`)) as JsonObject;
  }

  async cancelRun(id: string): Promise<void> {
    await this.call('POST', `/runs/${encodeURIComponent(id)}/cancel`);
  }

  /** Replaces what people wrote about a run. */
  async setNotes(id: string, tags: readonly string[], note: string): Promise<void> {
    await this.call('PUT', `/runs/${encodeURIComponent(id)}/notes`, { tags, note });
  }

  async differences(runs: readonly string[], signal: AbortSignal): Promise<Differences> {
    const place = `/differences?runs=${encodeURIComponent(runs.join(','))}`;
    return (await this.call('GET', place, undefined, {}, signal)) as Differences;
  }

  /** The report of runs that are over, as one HTML page. */
  async report(runs: readonly string[], alignment: string): Promise<Blob> {
    const query = new URLSearchParams({ runs: runs.join(','), alignment });
    return this.file(`/report?${query.toString()}`);
  }

  async deleteRun(id: string): Promise<void> {
    await this.call('DELETE', `/runs/${encodeURIComponent(id)}`);
  }

  async logs(): Promise<LogList> {
    return (await this.call('GET', '/logs')) as LogList;
  }

  /** The server stops reading when `signal` aborts. */
  async log(name: string, signal: AbortSignal): Promise<LogInfo> {
    const place = `/logs/${encodeURIComponent(name)}`;
    return (await this.call('GET', place, undefined, {}, signal)) as LogInfo;
  }

  /** @param source  stream of the positions; empty = the recommended truth */
  async logSeries(name: string, source: string, signal: AbortSignal): Promise<LogSeries> {
    const query = source === '' ? '' : `?source=${encodeURIComponent(source)}`;
    const place = `/logs/${encodeURIComponent(name)}/series${query}`;
    return (await this.call('GET', place, undefined, {}, signal)) as LogSeries;
  }

  /** @param id  for progress(), of this request only */
  async logResiduals(
    name: string,
    slice: { source: string; from_s: number | null; to_s: number | null; autoOffset: boolean },
    id: string,
    signal: AbortSignal,
  ): Promise<LogResiduals> {
    const query = new URLSearchParams({ progress: id });
    if (slice.source !== '') query.set('source', slice.source);
    if (slice.from_s !== null) query.set('from_s', String(slice.from_s));
    if (slice.to_s !== null) query.set('to_s', String(slice.to_s));
    if (slice.autoOffset) query.set('time_offset_s', 'auto');
    const place = `/logs/${encodeURIComponent(name)}/residuals?${query.toString()}`;
    return (await this.call('GET', place, undefined, {}, signal)) as LogResiduals;
  }

  /** null if the server does not know of it (yet, or any more). */
  async progress(id: string): Promise<WorkProgress | null> {
    try {
      return (await this.call('GET', `/progress/${encodeURIComponent(id)}`)) as WorkProgress;
    } catch {
      return null;
    }
  }

  async trajectories(): Promise<TrajectoryList> {
    return (await this.call('GET', '/trajectories')) as TrajectoryList;
  }

  async deleteTrajectory(name: string): Promise<void> {
    await this.call('DELETE', `/trajectories/${encodeURIComponent(name)}`);
  }

  /** The server stops scoring when `signal` aborts. */
  async evaluate(request: EvaluationRequest, signal: AbortSignal): Promise<Evaluation> {
    return (await this.call('POST', '/evaluations', request, {}, signal)) as Evaluation;
  }

  async uploadTrajectory(
    upload: Upload,
    name: string,
    body: Blob,
    onProgress: (share: number) => void,
  ): Promise<TrajectoryFile> {
    const url = `${this.base}/trajectories?name=${encodeURIComponent(name)}`;
    const never = new AbortController().signal;
    return (await this.send(upload, url, body, onProgress, never)) as TrajectoryFile;
  }

  async deleteLog(name: string): Promise<void> {
    await this.call('DELETE', `/logs/${encodeURIComponent(name)}`);
  }

  /** @param query  names the log, or the files of which the body consists */
  async uploadLog(
    upload: Upload,
    query: string,
    body: Blob,
    onProgress: (share: number) => void,
    signal: AbortSignal,
  ): Promise<LogEntry> {
    const url = `${this.base}/logs?${query}`;
    return (await this.send(upload, url, body, onProgress, signal)) as LogEntry;
  }

  private async send(
    upload: Upload,
    url: string,
    body: Blob,
    onProgress: (share: number) => void,
    signal: AbortSignal,
  ): Promise<unknown> {
    const { status, text } = await upload(url, body, onProgress, signal);
    if (status === kUnauthorized) this.onLocked();
    if (status !== 201) throw await errorOf(new Response(text, { status }));
    return JSON.parse(text);
  }

  /**
   * The reason why the server refuses the stream, because a browser does not report why a WebSocket
   * failed to open.
   */
  async streamRefusal(): Promise<RestError | null> {
    try {
      await this.call('GET', '/stream');
    } catch (error) {
      // If the stream is available, a request without an upgrade gets this answer.
      if (error instanceof RestError && error.code !== 'upgrade_required') return error;
    }
    return null;
  }

  async call(
    method: string,
    path: string,
    body?: unknown,
    headers: Record<string, string> = {},
    signal: AbortSignal | null = null,
  ): Promise<unknown> {
    const init: RequestInit = { method, headers: { ...headers }, signal };
    if (body !== undefined) {
      init.body = JSON.stringify(body);
      init.headers = { ...headers, 'Content-Type': 'application/json' };
    }
    return this.request(path, init);
  }

  /** An answer that is no JSON, to be saved. */
  async file(path: string): Promise<Blob> {
    return (await this.answer(path, { method: 'GET' })).blob();
  }

  /** With a file as the body. */
  async callWith(method: string, path: string, body: Blob): Promise<unknown> {
    return this.request(path, { method, body });
  }

  private async request(path: string, init: RequestInit): Promise<unknown> {
    const response = await this.answer(path, init);
    return response.status === 204 ? null : response.json();
  }

  private async answer(path: string, init: RequestInit): Promise<Response> {
    let response: Response;
    try {
      response = await this.fetch(`${this.base}${path}`, init);
    } catch {
      throw new RestError(0, 'unreachable', 'the server does not answer');
    }
    if (response.status === kUnauthorized) this.onLocked();
    if (!response.ok) throw await errorOf(response);
    return response;
  }
}
