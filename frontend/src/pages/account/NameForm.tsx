/** What others call me. */
import { Button, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Me, User } from "@/api/types";
import { Panel } from "@/design/Panel";
import styles from "./account.module.css";
import { Told } from "./Told";

const MOST_NAME = 100;

export function NameForm({ user }: { user: User }) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const [name, setName] = useState(user.name);
  const change = useMutation({
    mutationFn: () => api.put<Me>("/me/name", { name }),
    onSuccess: (me) => {
      queries.setQueryData(keys.me, me);
      setName(me.user?.name ?? name);
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    change.mutate();
  };
  return (
    <Panel className={styles.card}>
      <form className={styles.form} onSubmit={submit}>
        <h2>{t("pages.account.profile")}</h2>
        <TextInput
          label={t("pages.account.name")}
          description={t("pages.account.nameText")}
          autoComplete="name"
          maxLength={MOST_NAME}
          value={name}
          onChange={(event) => {
            if (!change.isIdle) change.reset();
            setName(event.currentTarget.value);
          }}
        />
        <Told error={change.error} done={change.isSuccess ? t("pages.account.nameChanged") : ""} />
        <Button type="submit" loading={change.isPending} disabled={name.trim() === "" || name.trim() === user.name}>
          {t("pages.account.rename")}
        </Button>
      </form>
    </Panel>
  );
}
