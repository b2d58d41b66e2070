/** Calls to the server: JSON in and out, refusals as ApiProblem. */
import i18next from "i18next";
import { refusalWords } from "@/i18n/refusals";

export interface FieldProblem {
  field: string;
  message: string;
}

/** A refusal; `detail` is a sentence for people. Status 0: the server did not answer. */
export class ApiProblem extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    readonly detail: string,
    readonly fields: readonly FieldProblem[] = [],
    /** What the refusal is made of, for who shows it at its place. */
    readonly args: Readonly<Record<string, unknown>> = {},
  ) {
    super(detail);
    this.name = "ApiProblem";
  }
}

/** The code of an answer that is not our server's own, such as that of a proxy before it. */
const UNEXPECTED = "unexpected";

/** Ask anew so often (ms), until our server says that this person may not know it, or that it is gone. */
export const untilRefused = (everyMs: number) => (query: { state: { error: Error | null } }) => {
  const { error } = query.state;
  const isRefused = error instanceof ApiProblem && [403, 404].includes(error.status) && error.code !== UNEXPECTED;
  return isRefused ? false : everyMs;
};

interface ProblemBody {
  code?: string;
  detail?: string;
  fields?: FieldProblem[];
  args?: Record<string, unknown>;
}

let token = "";

/** Keep the token that `/me` gave, for when the cookie cannot be read. */
export function rememberCsrf(csrf: string): void {
  token = csrf;
}

function csrfToken(): string {
  const cookie = document.cookie.split("; ").find((each) => each.startsWith("csrftoken="));
  return cookie ? decodeURIComponent(cookie.slice("csrftoken=".length)) : token;
}

async function send(
  method: string,
  path: string,
  body?: BodyInit,
  more: Readonly<Record<string, string>> = {},
): Promise<Response> {
  const headers = new Headers({ Accept: "application/json", ...more });
  if (method !== "GET") headers.set("X-CSRFToken", csrfToken());
  let response: Response;
  try {
    response = await fetch(`/api${path}`, { method, headers, body, credentials: "same-origin" });
  } catch {
    throw new ApiProblem(0, "offline", i18next.t("shell.problem.offline"));
  }
  if (!response.ok) throw await problemOf(response);
  return response;
}

async function problemOf(response: Response): Promise<ApiProblem> {
  const body = await response.json().then(asProblem, (): ProblemBody => ({}));
  const told = refusalWords(body.code ?? "", body.args);
  const detail = told ?? body.detail ?? i18next.t("shell.problem.unexpected", { status: response.status });
  return new ApiProblem(response.status, body.code ?? UNEXPECTED, detail, body.fields, body.args);
}

/** Others have codes that are no words, such as the number of a proxy. */
function asProblem(body: unknown): ProblemBody {
  if (typeof body !== "object" || body === null) return {};
  return "code" in body && typeof body.code !== "string" ? {} : body;
}

async function receive<T>(response: Response): Promise<T> {
  if (response.status === 204) return undefined as T;
  const text = await response.text();
  return (text ? JSON.parse(text) : undefined) as T;
}

const JSON_TYPE = { "Content-Type": "application/json" };

async function sendJson<T>(method: string, path: string, body?: unknown, tag?: string): Promise<T> {
  const payload = body === undefined ? undefined : JSON.stringify(body);
  return receive<T>(await send(method, path, payload, { ...(payload && JSON_TYPE), ...(tag && { "If-Match": tag }) }));
}

/** Ask for something that the server does once for this key, however often it is asked. */
async function postOnce<T>(path: string, body: unknown, key: string): Promise<T> {
  return receive<T>(await send("POST", path, JSON.stringify(body), { ...JSON_TYPE, "Idempotency-Key": key }));
}

/** Where the next part of a list is, as its header `Link` says. */
function nextOf(response: Response): string | undefined {
  const next = /<\/api([^>]*)>; rel="next"/.exec(response.headers.get("Link") ?? "");
  return next?.[1];
}

/** A whole list, which the server gives in parts. */
async function receiveAll<T>(path: string): Promise<T[]> {
  const all: T[] = [];
  for (let part: string | undefined = path; part !== undefined;) {
    const response = await send("GET", part);
    all.push(...(await receive<T[]>(response)));
    part = nextOf(response);
  }
  return all;
}

export interface ListPart<T> {
  items: T[];
  /** The path of the part behind it; undefined where nothing follows. */
  next: string | undefined;
  headers: Headers;
}

/** One part of a list that may be long. */
async function receivePart<T>(path: string): Promise<ListPart<T>> {
  const response = await send("GET", path);
  return { items: await receive<T[]>(response), next: nextOf(response), headers: response.headers };
}

/** What is there as bytes, and its ETag; empty where none came. */
async function receiveTagged(path: string): Promise<{ tag: string; bytes: Uint8Array<ArrayBuffer> }> {
  const response = await send("GET", path);
  return { tag: response.headers.get("ETag") ?? "", bytes: new Uint8Array(await response.arrayBuffer()) };
}

/** Put something in the place of what is there, if nobody changes that meanwhile. */
async function replace(path: string, body: unknown): Promise<void> {
  const known = await send("GET", path);
  await send("PUT", path, JSON.stringify(body), { ...JSON_TYPE, "If-Match": known.headers.get("ETag") ?? "" });
}

/** Paths begin after `/api`. Every call throws ApiProblem on a refusal. */
export const api = {
  get: <T>(path: string) => sendJson<T>("GET", path),
  all: receiveAll,
  part: receivePart,
  post: <T = void>(path: string, body?: unknown) => sendJson<T>("POST", path, body),
  postOnce,
  /** With a `tag` only what is still as it was read is replaced or deleted. */
  put: <T = void>(path: string, body: unknown, tag?: string) => sendJson<T>("PUT", path, body, tag),
  patch: <T = void>(path: string, body: unknown) => sendJson<T>("PATCH", path, body),
  replace,
  delete: <T = void>(path: string, tag?: string) => sendJson<T>("DELETE", path, undefined, tag),
  upload: async <T>(path: string, form: FormData, headers: Readonly<Record<string, string>> = {}) =>
    receive<T>(await send("POST", path, form, headers)),
  text: async (path: string) => (await send("GET", path)).text(),
  tagged: receiveTagged,
  bytes: async (path: string) => (await receiveTagged(path)).bytes,
};
