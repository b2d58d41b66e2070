/** The bell of robots that wait to be let in, in a script of its own that comes once the screen stands. */
import { lazy, Suspense } from "react";
import { loadScreenTexts } from "@/i18n";
import type { AdmissionsBell } from "./AdmissionsBell";

/** So long after the first screen has come, and again where it could not be fetched; milliseconds. */
const AFTER_MS = 1500;
const AGAIN_MS = 10_000;

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));

async function fetchBell(): Promise<{ default: typeof AdmissionsBell }> {
  try {
    const [module] = await Promise.all([import("./AdmissionsBell"), loadScreenTexts()]);
    return { default: module.AdmissionsBell };
  } catch {
    await pause(AGAIN_MS); // meanwhile the connection's strip says that the server is away
    return fetchBell();
  }
}

const Bell = lazy(() => pause(AFTER_MS).then(fetchBell));

export function LateBell({ slug }: { slug: string }) {
  return (
    <Suspense fallback={null}>
      <Bell slug={slug} />
    </Suspense>
  );
}
