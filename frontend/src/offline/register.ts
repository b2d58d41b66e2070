/** The page's side of the service worker: it is started, and says when the page is older than the server's. */
import { isNeeded, ME } from "./kept";

const LOOK_MS = 30 * 60 * 1000;
/** An answer that was under way when the worker came is on the list only when it is there. */
const READ_AGAIN_MS = [0, 2000, 8000];
const listeners = new Set<() => void>();
let old = false;

/** Whether the server has a newer page than this one. */
export const isOld = (): boolean => old;

export function onOld(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Browsers without service workers, and pages that did not come safely, work as long as the server answers. */
export function startOffline(): void {
  if (!("serviceWorker" in navigator)) return;
  const workers = navigator.serviceWorker;
  let had = workers.controller !== null;
  workers.addEventListener("controllerchange", () => {
    if (had) void lookForNew();
    else void readAgain();
    had = true;
  });
  void workers.register("/worker.js").then(
    (registration) => {
      setInterval(() => void look(registration), LOOK_MS);
      document.addEventListener("visibilitychange", () => {
        if (document.visibilityState === "visible") void look(registration);
      });
    },
    () => {}, // private windows of some browsers allow none
  );
}

async function look(registration: ServiceWorkerRegistration): Promise<void> {
  await registration.update().catch(() => {});
  await lookForNew();
}

/** The page names its script by its content: another name is another version. */
async function lookForNew(): Promise<void> {
  const answer = await fetch("/", { cache: "no-store" }).catch(() => null);
  if (!answer?.ok) return;
  const script = entryOf(await answer.text());
  const own = document.querySelector<HTMLScriptElement>('script[type="module"][src]')?.getAttribute("src");
  if (!script || !own || script === own) return;
  old = true;
  for (const listener of listeners) listener();
}

/** The script of a page of ours; null in any other page. */
export function entryOf(page: string): string | null {
  return /<script type="module"[^>]* src="(\/assets\/[^"]+)"/.exec(page)?.[1] ?? null;
}

/** What this page has read past the first worker, before it was there to keep it, is read once more through it. */
async function readAgain(): Promise<void> {
  await fetch(ME).catch(() => null); // whose answers they are is known first
  const done = new Set<string>();
  for (const wait of READ_AGAIN_MS) {
    await new Promise((ready) => setTimeout(ready, wait));
    const past = performance
      .getEntriesByType("resource")
      .filter((entry) => entry instanceof PerformanceResourceTiming && entry.workerStart === 0);
    const needed = past
      .map(({ name }) => new URL(name))
      .filter((url) => url.origin === location.origin && isNeeded(url));
    const missing = needed.map(({ href }) => href).filter((href) => !done.has(href));
    for (const href of new Set(missing)) {
      done.add(href);
      await fetch(href).catch(() => null);
    }
  }
}
