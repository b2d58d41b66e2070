/** What a run still needs before it may start on devices: shown before the button is pressed. */
import { TextInput } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Role } from "@/api/types";
import { AskForReview } from "./AskForReview";
import { factsOf, useReview } from "./review";
import { ReviewFacts } from "./ReviewFacts";
import styles from "./review.module.css";

/** How the content stands, and the reason of an emergency as it is typed; `open` once a run may be asked for. */
export function useRunReview(program: string, version: number | null) {
  const review = useReview(program, version).data;
  const [reason, setReason] = useState("");
  const missing = review !== undefined && !review.may_run;
  const emergency = missing ? reason.trim() : "";
  return {
    review,
    reason,
    setReason,
    missing,
    emergency,
    open: review !== undefined && (!missing || emergency !== ""),
  };
}

interface BeforeProps {
  program: string;
  version: number | null;
  role: Role;
  state: ReturnType<typeof useRunReview>;
  before?: () => Promise<void>;
}

export function ReviewBeforeRun({ program, version, role, state, before }: BeforeProps) {
  const { t } = useTranslation();
  const { review, missing } = state;
  if (!review || review.needed === 0) return null;
  return (
    <div className={styles.before}>
      <ReviewFacts facts={factsOf(review, t)} />
      {missing ? (
        <>
          <p>{t(`review.who.${review.least_role}`)}</p>
          <AskForReview program={program} version={version} {...(before ? { before } : {})} />
        </>
      ) : null}
      {missing && role === "admin" ? (
        <TextInput
          label={t("review.emergency")}
          description={t("review.emergency_text")}
          maxLength={500}
          value={state.reason}
          onChange={(event) => state.setReason(event.currentTarget.value)}
        />
      ) : null}
    </div>
  );
}
