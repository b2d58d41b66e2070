/** What came to pass between robots, in words. */
import i18next from "i18next";
import { waitWords } from "@/i18n/waits";
import type { Incident } from "@/scene3d/incidents";

export function incidentWords({ kind, encounter, wait }: Incident, nameOf: (device: string) => string): string {
  if (wait) return waitWords(wait.why, nameOf) ?? wait.reason;
  if (!encounter) return "";
  const name = (id: string) => (id === "wall" ? i18next.t("simulation.wall") : nameOf(id));
  const cm = Math.max(0, Math.round(encounter.distance_m * 100));
  return i18next.t(`simulation.${kind}`, { a: name(encounter.a), b: name(encounter.b), cm });
}
