/** Signing out takes along what this browser keeps of the person; what is not saved yet is asked about before. */
import { Button, Modal } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueries, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, type To } from "react-router-dom";
import { api } from "@/api/client";
import { listCopies, removeAll, type KeptCopy } from "@/api/localCopies";
import { keys, useMe } from "@/api/queries";
import type { Program } from "@/api/types";
import styles from "./shell.module.css";

export interface SigningOut {
  /** Copies of this person with changes that wait; asked about while there are any. */
  readonly waiting: readonly KeptCopy[];
  readonly isPending: boolean;
  readonly isSuccess: boolean;
  /** Sign out, or ask first. */
  readonly ask: () => void;
  readonly signOut: () => void;
  readonly stay: () => void;
}

/** `to` is where one signs in again. */
export function useSignOut(path: "/sign-out" | "/me/sign-out-everywhere", to: To = "/sign-in"): SigningOut {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const navigate = useNavigate();
  const person = useMe().data?.user?.id;
  const [waiting, setWaiting] = useState<readonly KeptCopy[]>([]);
  const end = useMutation({
    mutationFn: async () => {
      const told = await api.post<{ provider_sign_out?: string }>(path);
      await removeAll();
      return told.provider_sign_out;
    },
    onSuccess: async (elsewhere) => {
      await navigate(to);
      queries.clear();
      notifications.clean(); // what they say and offer was for who has left
      if (elsewhere) location.assign(elsewhere);
    },
    onError: () => notifications.show({ color: "red", message: t("shell.signOut.failed") }),
  });
  const ask = async () => {
    const mine = (await listCopies()).filter((copy) => copy.person === String(person) && copy.waiting > 0);
    if (mine.length === 0) end.mutate();
    setWaiting(mine);
  };
  return {
    waiting,
    isPending: end.isPending,
    isSuccess: end.isSuccess,
    ask: () => void ask(),
    signOut: () => end.mutate(),
    stay: () => setWaiting([]),
  };
}

export function SignOutQuestion({ signOut }: { signOut: SigningOut }) {
  const { t } = useTranslation();
  const { waiting } = signOut;
  const count = waiting.reduce((sum, copy) => sum + copy.waiting, 0);
  return (
    <Modal opened={waiting.length > 0} onClose={signOut.stay} title={t("shell.signOut.title")} size={460}>
      <div className={styles.question}>
        <p>{t("shell.signOut.text", { count })}</p>
        <WaitingPrograms waiting={waiting} leave={signOut.stay} />
        <p>{t("shell.signOut.hint")}</p>
        <div className={styles.questionButtons}>
          <Button variant="default" onClick={signOut.stay} data-autofocus>
            {t("shell.signOut.stay")}
          </Button>
          <Button color="red.9" loading={signOut.isPending} onClick={signOut.signOut}>
            {t("shell.signOut.anyway")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

function WaitingPrograms({ waiting, leave }: { waiting: readonly KeptCopy[]; leave: () => void }) {
  const { t } = useTranslation();
  const programs = useQueries({
    queries: waiting.map(({ program }) => ({
      queryKey: keys.program(program),
      queryFn: () => api.get<Program>(`/programs/${program}`),
    })),
  });
  return (
    <ul>
      {waiting.map((copy, index) => (
        <li key={copy.database}>
          <Link to={`/programs/${copy.program}`} onClick={leave}>
            {programs[index]?.data?.name ?? t("shell.signOut.program")}
          </Link>
          {": "}
          {t("shell.signOut.waits", { count: copy.waiting })}
        </li>
      ))}
    </ul>
  );
}
