/** An enrolment key, with which any number of devices bring keys of their own. */
import { Button, TextInput } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import type { Enrolment } from "@/api/types";
import type { Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { CopyText } from "./CopyText";
import styles from "./enrolment.module.css";

export function ManyDevices({ site }: { site: Site }) {
  const { t } = useTranslation();
  const renew = useMutation({ mutationFn: () => api.post<Enrolment>(`/sites/${site.slug}/join-key`) });
  return (
    <div className={styles.stack}>
      <p>{t("adding.manyText")}</p>
      {renew.data ? (
        <>
          <div className={styles.row}>
            <TextInput
              className={styles.field}
              classNames={{ input: styles.mono }}
              label={t("adding.enrolmentKey")}
              description={t("adding.enrolmentKeyHelp", { site: site.slug })}
              readOnly
              value={renew.data.join_key}
              onFocus={(event) => event.currentTarget.select()}
            />
            <CopyText value={renew.data.join_key} />
          </div>
          <p className={styles.quiet}>
            {renew.data.broker ? t("adding.brokerIs", { broker: renew.data.broker }) : t("adding.brokerUnknown")}
          </p>
        </>
      ) : (
        <>
          <p className={styles.once}>{t("adding.manyWarning")}</p>
          <Button className={styles.go} loading={renew.isPending} onClick={() => renew.mutate()}>
            {t("adding.newEnrolmentKey")}
          </Button>
        </>
      )}
      {renew.isError ? (
        <p role="alert" className={styles.problem}>
          {problemText(renew.error, t("shell.problem.screen"))}
        </p>
      ) : null}
    </div>
  );
}
