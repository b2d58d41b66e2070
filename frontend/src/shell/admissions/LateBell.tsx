/** The bell of robots that wait to be let in, in a script of its own that comes once the screen stands. */
import { lazy, Suspense } from "react";
import { loadScreenTexts } from "@/i18n";

/** So long after the first screen has come; milliseconds. */
const AFTER_MS = 1500;

const Bell = lazy(async () => {
  await new Promise((done) => setTimeout(done, AFTER_MS));
  try {
    const [{ AdmissionsBell }] = await Promise.all([import("./AdmissionsBell"), loadScreenTexts()]);
    return { default: AdmissionsBell };
  } catch {
    return { default: () => null }; // the connection's strip says that the server is away
  }
});

export function LateBell({ slug }: { slug: string }) {
  return (
    <Suspense fallback={null}>
      <Bell slug={slug} />
    </Suspense>
  );
}
