/** How many questions wait at the site, with the questions behind it; new ones and notices come as toasts. */
import { Popover } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import i18next from "i18next";
import { CircleHelp } from "lucide-react";
import { lazy, Suspense, useEffect } from "react";
import { useTranslation } from "react-i18next";
import { useQuestions, useSite } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Question } from "@/api/types";
import { type Notice, useLiveStore } from "@/live/store";
import styles from "./questions.module.css";
import { openCount, shownQuestions } from "./openQuestions";

/** Loaded with the first question. */
const QuestionCard = lazy(async () => ({ default: (await import("./QuestionCard")).QuestionCard }));
const NONE: Question[] = [];
/** What this browser has shown as a toast, for all pages of the visit. */
const toasted = new Set<string>();
let lastNotice = 0;

function useToasts(questions: readonly Question[], allowed: boolean): void {
  const { t } = useTranslation();
  const notices = useLiveStore((state) => state.notices);
  useEffect(() => {
    for (const question of questions) {
      if (question.state !== "open") notifications.hide(question.id);
      if (!allowed || question.state !== "open" || toasted.has(question.id)) continue;
      toasted.add(question.id);
      const title = t("run.question.asks", { number: question.run_number });
      notifications.show({ id: question.id, title, message: question.text, color: "yellow", autoClose: 12_000 });
    }
  }, [questions, allowed, t]);
  useEffect(() => {
    for (const notice of notices) {
      if (notice.id <= lastNotice) continue;
      lastNotice = notice.id;
      const color = notice.level === "warning" ? "yellow" : "blue";
      notifications.show({ message: wordsOf(notice), color, autoClose: 8000 });
    }
    if (notices.length === 0) lastNotice = 0;
  }, [notices]);
}

/** A notice of VIPO in the language of the screen; a program's own as it says it. */
function wordsOf(notice: Notice): string {
  const key = `run.event.${notice.code}`;
  return notice.code && i18next.exists(key) ? i18next.t(key, { ...notice.args }) : notice.text;
}

export function QuestionsBell({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const role = useSite(slug).data?.role;
  const questions = useQuestions(slug).data ?? NONE;
  const allowed = mayOperate(role);
  useToasts(questions, allowed);
  const count = openCount(questions);
  if (count === 0) return null;
  return (
    <Popover position="bottom-end" width={340} shadow="md" withinPortal trapFocus>
      <Popover.Target>
        <button type="button" className={styles.bell} aria-label={t("run.question.open", { count })}>
          <CircleHelp size={17} aria-hidden /> <b>{count}</b>
        </button>
      </Popover.Target>
      <Popover.Dropdown className={styles.list}>
        <Suspense fallback={null}>
          {shownQuestions(questions).map((question) => (
            <QuestionCard key={question.id} question={question} allowed={allowed} />
          ))}
        </Suspense>
      </Popover.Dropdown>
    </Popover>
  );
}
