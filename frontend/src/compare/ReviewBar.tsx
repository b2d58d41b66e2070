/** The review of what is on the new side: how it stands, what changed since it was approved, and the verdict. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { Check, MessageSquareWarning } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { FactList } from "@/design/FactList";
import { AskForReview } from "@/shell/review/AskForReview";
import { NoteForm } from "@/shell/review/NoteForm";
import { factsOf, findingsOf, isReviewed, useReview, useVerdict, type Verdict } from "@/shell/review/review";
import { factOfTests, useVersionTests } from "@/shell/review/versionTests";
import { mayOperate } from "@/api/roles";
import type { Review, Role } from "@/api/types";
import { tellRefusal } from "@/shell/refusal";
import styles from "./compare.module.css";
import { DRAFT } from "./sides";

interface BarProps {
  program: string;
  role: Role;
  /** The sides as versions' numbers or `draft`; null while they are not known. */
  asked: readonly [string, string] | null;
  onSince: (old: string) => void;
}

export function ReviewBar({ program, role, asked, onSince }: BarProps) {
  const { t } = useTranslation();
  const side = asked?.[1];
  const number = side === undefined || side === "0" ? undefined : side === DRAFT ? null : Number(side);
  const review = useReview(program, number).data;
  const tested = useVersionTests(program).data?.find((each) => each.number === number);
  const tests = factOfTests(tested, t);
  if (!isReviewed(review))
    return tests ? (
      <div className={styles.review}>
        <FactList label={t("tests.list")} facts={[tests]} />
      </div>
    ) : null;
  const since = review.compare_with;
  return (
    <div className={styles.review}>
      <FactList
        label={t("review.title")}
        facts={[...factsOf(review, t), ...findingsOf(review, t), ...(tests ? [tests] : [])]}
      />
      <div className={styles.verdict}>
        {since !== null && String(since) !== asked?.[0] ? (
          <Button size="xs" variant="default" onClick={() => onSince(String(since))}>
            {t("review.since", { number: since })}
          </Button>
        ) : null}
        {!mayOperate(role) || review.may_run || review.why_not === "" ? null : (
          <AskForReview program={program} version={number ?? null} />
        )}
        {review.number === null || !mayOperate(role) ? null : (
          <Say key={review.number} program={program} review={review} number={review.number} />
        )}
      </div>
    </div>
  );
}

function Say({ program, review, number }: { program: string; review: Review; number: number }) {
  const { t } = useTranslation();
  const [asks, setAsks] = useState(false);
  const verdict = useVerdict(program, number);
  /** The answer is told also where another version is looked at by then. */
  const say = (said: Verdict, note = "") =>
    verdict.mutateAsync({ verdict: said, note }).then(
      () => {
        setAsks(false);
        notifications.show({ message: t(`review.said.${said}`, { number }) });
      },
      (error: Error) => tellRefusal(error, t),
    );
  const mine = review.history.filter((word) => word.mine && word.kind !== "asked").at(-1);
  if (asks)
    return (
      <NoteForm
        label={t("review.changes_note")}
        send={t("review.changes")}
        required
        busy={verdict.isPending}
        error={null}
        onSend={(note) => void say("changes", note)}
        onCancel={() => setAsks(false)}
      />
    );
  return (
    <>
      {review.why_not === "own" ? <small>{t("review.own")}</small> : null}
      {review.why_not === "role" ? <small>{t(`review.who.${review.least_role}`)}</small> : null}
      {review.why_not === "" ? (
        <>
          {mine?.kind === "approved" ? null : (
            <Button
              size="xs"
              aria-label={t("review.approve_label", { number })}
              leftSection={<Check size={14} aria-hidden="true" />}
              loading={verdict.isPending}
              onClick={() => void say("approved")}
            >
              {t("review.approve")}
            </Button>
          )}
          <Button
            size="xs"
            variant="default"
            leftSection={<MessageSquareWarning size={14} aria-hidden="true" />}
            onClick={() => setAsks(true)}
          >
            {t("review.changes")}
          </Button>
        </>
      ) : null}
      {mine && mine.kind !== "withdrawn" ? (
        <Button size="xs" variant="default" loading={verdict.isPending} onClick={() => void say("withdrawn")}>
          {t("review.withdraw")}
        </Button>
      ) : null}
    </>
  );
}
