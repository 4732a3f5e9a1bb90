import { describe, expect, it } from 'vitest';
import { RestClient } from '../../src/connection/rest_client';
import { sampleRun } from '../support/samples';

function answering(status: number, body: unknown) {
  const calls: { url: string; init: RequestInit | undefined }[] = [];
  const client = new RestClient('api/v1', (url, init) => {
    calls.push({ url, init });
    const text = status === 204 ? null : typeof body === 'string' ? body : JSON.stringify(body);
    return Promise.resolve(new Response(text, { status }));
  });
  return { client, calls };
}

describe('RestClient', () => {
  it('starts a run with its overrides and an idempotency key', async () => {
    const { client, calls } = answering(201, sampleRun());
    const run = await client.startRun('course', { duration_s: 20 }, 'key');
    expect(run.id).toBe('r1');
    expect(calls[0]?.url).toBe('api/v1/runs');
    expect(calls[0]?.init?.method).toBe('POST');
    expect(calls[0]?.init?.headers).toMatchObject({ 'Idempotency-Key': 'key' });
    expect(JSON.parse(calls[0]?.init?.body as string)).toEqual({
      scenario: 'course',
      overrides: { duration_s: 20 },
    });
  });

  it('accepts an answer without a body', async () => {
    const { client, calls } = answering(204, '');
    await client.deleteRun('a/b');
    expect(calls[0]?.url).toBe('api/v1/runs/a%2Fb');
  });

  it("passes on the server's error", async () => {
    const { client } = answering(409, { error: { code: 'conflict', message: 'it still runs' } });
    await expect(client.deleteRun('r1')).rejects.toMatchObject({
      status: 409,
      code: 'conflict',
      message: 'it still runs',
    });
  });

  it('reports the status if the response is not an error document', async () => {
    const { client } = answering(502, '<html>');
    await expect(client.runs()).rejects.toMatchObject({ status: 502, code: 'http' });
  });

  it('reports a rejected token', async () => {
    let locked = 0;
    const refused = { error: { code: 'unauthorized', message: 'token' } };
    const client = new RestClient(
      'api/v1',
      () => Promise.resolve(new Response(JSON.stringify(refused), { status: 401 })),
      () => (locked += 1),
    );
    await expect(client.runs()).rejects.toMatchObject({ status: 401, code: 'unauthorized' });
    expect(await client.streamRefusal()).toMatchObject({ status: 401 });
    expect(locked).toBe(2);
  });

  it('takes an answer that asks for an upgrade as no refusal of the stream', async () => {
    const { client, calls } = answering(426, {
      error: { code: 'upgrade_required', message: 'request an upgrade' },
    });
    expect(await client.streamRefusal()).toBeNull();
    expect(calls[0]?.url).toBe('api/v1/stream');
  });

  it('reports an unreachable server', async () => {
    const client = new RestClient('api/v1', () => Promise.reject(new TypeError('refused')));
    await expect(client.runs()).rejects.toMatchObject({ status: 0, code: 'unreachable' });
  });

  it('uploads a log and passes on why it was refused', async () => {
    const { client } = answering(200, {});
    const urls: string[] = [];
    const send = (status: number, body: unknown) =>
      client.uploadLog(
        (url, _file, onProgress) => {
          urls.push(url);
          onProgress(1);
          return Promise.resolve({ status, text: JSON.stringify(body) });
        },
        'name=a%20b.bin',
        new Blob(['x']),
        () => {},
        new AbortController().signal,
      );
    expect(await send(201, { name: 'uploads/a_b.bin' })).toEqual({ name: 'uploads/a_b.bin' });
    expect(urls).toEqual(['api/v1/logs?name=a%20b.bin']);
    const full = { error: { code: 'quota_exceeded', message: 'no room' } };
    await expect(send(507, full)).rejects.toMatchObject({ status: 507, message: 'no room' });
  });
});
