/** A button for each provider by which people may sign in or join; nothing where there is none. */
import { Button } from "@mantine/core";
import { CircleAlert, LogIn } from "lucide-react";
import { useTranslation } from "react-i18next";
import { problemText } from "@/shell/LoadProblem";
import { useBeginSignOn, useProviders } from "./providers";
import styles from "./SignInPage.module.css";

export function ProviderButtons({ next = "", invitation = "" }: { next?: string; invitation?: string }) {
  const { t } = useTranslation();
  const providers = useProviders();
  const begin = useBeginSignOn();
  return (
    <>
      {begin.isError ? (
        <p className={styles.refused} role="alert">
          <CircleAlert size={16} aria-hidden="true" />
          {problemText(begin.error, t("shell.problem.screen"))}
        </p>
      ) : null}
      {(providers.data ?? []).map(({ name, title }) => (
        <Button
          key={name}
          variant="default"
          size="md"
          leftSection={<LogIn size={16} aria-hidden="true" />}
          loading={(begin.isPending || begin.isSuccess) && begin.variables.provider === name}
          onClick={() => begin.mutate({ provider: name, next, invitation })}
        >
          {t(invitation ? "signOn.joinBy" : "signOn.by", { title })}
        </Button>
      ))}
    </>
  );
}
