/** In words how far a rehearsal is: steps, the step that it is at, and its virtual time. */
import i18next from "i18next";
import type { RehearsalCourse } from "@/api/types";
import { clock } from "@/design/clock";

export function progressWords(course: RehearsalCourse, numbers: Readonly<Record<string, string>> = {}): string {
  const number = numbers[course.step];
  const steps = { done: course.steps_done, steps: course.steps };
  const parts = [
    i18next.t(course.end_known ? "simulation.queue.steps" : "simulation.queue.stepsOnce", steps),
    number ? i18next.t("simulation.queue.at", { number }) : "",
    i18next.t("simulation.queue.virtual", { time: clock(course.virtual_s) }),
  ];
  return parts.filter(Boolean).join(" · ");
}
