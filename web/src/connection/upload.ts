// Sends a file with progress, which fetch cannot report.

export interface UploadAnswer {
  status: number;
  text: string;
}

export type Upload = (
  url: string,
  file: Blob,
  onProgress: (share: number) => void,
  signal: AbortSignal,
) => Promise<UploadAnswer>;

export const uploadByBrowser: Upload = (url, file, onProgress, signal) =>
  new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', url);
    request.setRequestHeader('Content-Type', 'application/octet-stream');
    request.upload.addEventListener('progress', ({ loaded, total }) => {
      if (total > 0) onProgress(loaded / total);
    });
    request.addEventListener('load', () => {
      resolve({ status: request.status, text: request.responseText });
    });
    const fail = (text: string) => () => reject(new Error(text));
    request.addEventListener('error', fail('the server does not answer'));
    request.addEventListener('abort', fail('cancelled'));
    signal.addEventListener('abort', () => request.abort());
    request.send(file);
  });
