/** Whether I want the mail that the server sends me by itself; nothing where it sends none. */
import { Switch } from "@mantine/core";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import type { MyMail } from "@/api/types";
import { Panel } from "@/design/Panel";
import { problemText } from "@/shell/LoadProblem";
import styles from "./account.module.css";

const KEY = ["my-mail"];

export function Mail() {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const mail = useQuery({ queryKey: KEY, queryFn: () => api.get<MyMail>("/me/mail") }).data;
  const choose = useMutation({
    mutationFn: (wanted: boolean) => api.put("/me/mail", { wanted }),
    onSettled: () => queries.invalidateQueries({ queryKey: KEY }),
  });
  if (!mail?.can_mail) return null;
  return (
    <Panel className={styles.card}>
      <div className={styles.form}>
        <h2>{t("pages.account.mail")}</h2>
        <Switch
          label={t("pages.account.mailSwitch")}
          description={t("pages.account.mailText")}
          checked={choose.isPending ? choose.variables : mail.wanted}
          onChange={(event) => choose.mutate(event.currentTarget.checked)}
        />
        {choose.error ? <p role="alert">{problemText(choose.error, t("shell.problem.screen"))}</p> : null}
      </div>
    </Panel>
  );
}
